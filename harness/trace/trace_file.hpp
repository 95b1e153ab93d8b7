// Traces in HDF5: written at once and read back. trace_writer.hpp writes them step by step.
//
//   write_trace("out/episode.h5", trace);
//   Trace again = read_trace("out/episode.h5");
//
// The layout is in trace_layout.cpp and, for users, in docs/trace.md.
#pragma once

#include <string>

#include "harness/trace/trace.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// What a controller outside of the program wrote to its standard error, beside the trace.
inline constexpr const char* kControllerLog = "controller.log";

/// Writes it into `folder` where there is any, and else removes what an earlier drive left there.
/// Throws IoError.
void write_controller_log(const Trace& trace, const std::string& folder);

/// What the trace of an episode is called within its folder.
inline constexpr const char* kTraceFile = "episode.h5";

/// Writes a whole trace at once. Throws as TraceWriter does.
void write_trace(const std::string& path, const Trace& trace);

/// Reads a trace, or the partial file of a killed episode: its outcome is then kInterrupted and its
/// final_state empty. Throws InputError on a file that is missing, damaged, not a trace or of
/// another schema, and IoError where the system refuses to read it.
[[nodiscard]] Trace read_trace(const std::string& path);

/// Reads the trace in `folder`, or its partial file where an episode was killed. Throws as
/// `read_trace`.
[[nodiscard]] Trace read_folder(const std::string& folder);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
