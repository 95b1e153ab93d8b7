// What is kept of a launch: the record, by which later processes find it, and in the campaign's
// folder how its tasks ended.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/cluster/launch/launcher.hpp"
#include "harness/cluster/launch/process_identity.hpp"

namespace qsmpc::harness {

struct LaunchRecord {
  std::string kind;    ///< "local", "ssh" or "slurm"
  std::string launch;  ///< its name, which no other launch of the folder has
  std::string folder;  ///< the campaign's
  int tasks = 0;
  std::vector<std::string> where{};  ///< local, ssh: the machine of each task, by its number
  ProcessIdentity conductor{};       ///< local, ssh: the process that started them
  std::string job{};                 ///< slurm: the array's number
  std::string gather_job{};          ///< slurm: that of the job after it; empty: none

  friend bool operator==(const LaunchRecord&, const LaunchRecord&) = default;
};

/// As one line of JSON, and back. The second throws InputError on something else.
[[nodiscard]] std::string launch_record_text(const LaunchRecord& record);
[[nodiscard]] LaunchRecord launch_record_of(const std::string& text);

/// Begins a launch in the campaign's folder: the folders for its logs and ends are there when it
/// returns. Returns its name. Throws IoError.
[[nodiscard]] std::string begin_launch(const std::string& folder);

/// `cluster/ends/LAUNCH` of the campaign's folder. A file TASK in it begins with the condition in
/// which the task ended; the rest of it is the note. A file `cancelled` says that the launch was.
[[nodiscard]] std::string ends_folder(const std::string& folder, const std::string& launch);

/// Of a task that has ended: `condition`, `note` and `task`. Throws IoError.
void write_task_end(const LaunchRecord& record, const TaskState& end);
/// Nothing where it has not. Throws InputError where the file says something else.
[[nodiscard]] std::optional<TaskState> read_task_end(const LaunchRecord& record, int task);

/// Throws IoError.
void mark_cancelled(const LaunchRecord& record);
[[nodiscard]] bool is_cancelled(const LaunchRecord& record);

}  // namespace qsmpc::harness
