// Traces in HDF5: written in one go and read back. trace_writer.hpp writes them step by step.
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

/// Name of the file beside the trace with what an external controller wrote to its standard error.
inline constexpr const char* kControllerLog = "controller.log";

/// Writes the controller's log into `folder`; if there is none, removes that of an earlier drive.
/// Throws IoError.
void write_controller_log(const Trace& trace, const std::string& folder);

/// Name of an episode's trace within its folder.
inline constexpr const char* kTraceFile = "episode.h5";

/// Writes a whole trace in one go. Throws as TraceWriter does.
void write_trace(const std::string& path, const Trace& trace);

/// Reads a trace, or the partial file of a killed episode, whose outcome is then kInterrupted and
/// whose final_state is empty. Throws InputError on a file that is missing, damaged, not a trace or
/// of another schema, and IoError if the system refuses to read it.
[[nodiscard]] Trace read_trace(const std::string& path);

/// Reads the trace in `folder`, or its partial file if the episode was killed. Throws as
/// `read_trace`.
[[nodiscard]] Trace read_folder(const std::string& folder);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
