// A trace in HDF5, written step by step while an episode runs.
//
//   TraceWriter writer("out/episode.h5", header);
//   for (…) writer.append(record, motion_of_the_period);
//   writer.finish(trace);                       // now out/episode.h5 is there
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "harness/trace/hdf5_file.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// Streams one episode to `PATH.partial`, which `finish` renames to PATH. If the writer is
/// destroyed without `finish`, or the process is killed, the partial file remains with every step
/// for which `append` returned; `read_trace` reads it as an interrupted episode. A file already at
/// PATH stays.
class TraceWriter {
 public:
  /// `header`: only scenario, scenario_text, system, seed and version are used.
  /// Throws IoError if the file cannot be created.
  explicit TraceWriter(std::string path, const Trace& header);

  /// Adds one step and the motion samples since the last one; on return the operating system has
  /// both. Throws IoError if they cannot be written (nothing more can be written then), and
  /// std::invalid_argument if the sizes in `record` do not fit the scenario.
  void append(const StepRecord& record, std::span<const MotionSample> motion);

  /// Adds outcome, fault and final_state of `trace`, makes the file durable and renames it to PATH.
  /// final_state may be empty. To be called once, as the last call. Throws IoError.
  void finish(const Trace& trace);

  [[nodiscard]] const std::string& partial_path() const { return file_.path(); }

 private:
  void append_motion(std::span<const MotionSample> motion);
  void append_vectors(const StepRecord& record);
  void append_plan(const StepRecord& record);
  void append_particles(const StepRecord& record);
  void append_timing(const StepTiming& timing);
  void check_sizes(const StepRecord& record) const;
  void check_plan(const StepRecord& record) const;

  std::string path_;
  Hdf5File file_;
  Eigen::Index state_dim_;
  Eigen::Index input_dim_;
  bool is_solid_ = false;            ///< whether the records have contacts
  Eigen::Index obstacles_;           // moving ones
  controller::DecisionParts parts_;  ///< that the records have
  Eigen::Index stages_;              ///< with a certificate
  std::int64_t points_ = 0;          ///< particles written so far
  std::size_t qpos_size_ = 0;        ///< coordinates of a motion sample
  bool motion_begun_ = false;
  bool broken_ = false;  ///< a step was partly written; later rows would be misaligned
};

}  // namespace qsmpc::harness
