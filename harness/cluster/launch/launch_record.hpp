// Persistent data of a launch: the record, by which later processes find it, and in the campaign's
// folder the ends of its tasks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/cluster/launch/launcher.hpp"
#include "harness/cluster/launch/process_identity.hpp"

namespace qsmpc::harness {

struct LaunchRecord {
  std::string kind;    ///< "local", "ssh" or "slurm"
  std::string launch;  ///< its name, unique among the folder's launches
  std::string folder;  ///< the campaign's
  int tasks = 0;
  std::vector<std::string> where{};  ///< local, ssh: the machine of each task, by its number
  ProcessIdentity conductor{};       ///< local, ssh: the process that started them
  std::string job{};                 ///< slurm: the number of the job array
  std::string gather_job{};          ///< slurm: the number of the job after it; empty: none

  friend bool operator==(const LaunchRecord&, const LaunchRecord&) = default;
};

/// Converts a record to one line of JSON, and back. The second function throws InputError on any
/// other text.
[[nodiscard]] std::string launch_record_text(const LaunchRecord& record);
[[nodiscard]] LaunchRecord launch_record_of(const std::string& text);

/// Begins a launch in the campaign's folder: creates the folders for its logs and task ends, and
/// returns its name. Throws IoError.
[[nodiscard]] std::string begin_launch(const std::string& folder);

/// `cluster/ends/LAUNCH` of the campaign's folder. A file TASK in it starts with the condition in
/// which the task ended, followed by the note. A file `cancelled` means that the launch was
/// cancelled.
[[nodiscard]] std::string ends_folder(const std::string& folder, const std::string& launch);

/// Writes `condition` and `note` of the ended task `end.task`. Throws IoError.
void write_task_end(const LaunchRecord& record, const TaskState& end);
/// The end of `task`; nothing if it has not ended. Throws InputError if the file is malformed.
[[nodiscard]] std::optional<TaskState> read_task_end(const LaunchRecord& record, int task);

/// Throws IoError.
void mark_cancelled(const LaunchRecord& record);
[[nodiscard]] bool is_cancelled(const LaunchRecord& record);

}  // namespace qsmpc::harness
