// The last launch of a campaign's tasks, kept in its folder so that any process with access can
// query, end and restart them.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace qsmpc::harness {

struct TaskLaunch {
  std::int64_t launch = 0;               ///< 1, 2, …
  std::string options{};                 ///< the launcher's, as launch_options_text
  std::string record{};                  ///< the launcher's record; empty while it starts the tasks
  int jobs = 0;                          ///< concurrent episodes per task; 0: one per core
  std::chrono::seconds lost_after{120};  ///< LeaseQueue::Options::lost_after
};

/// The last launch; nothing if no tasks were ever started. Throws IoError.
[[nodiscard]] std::optional<TaskLaunch> read_task_launch(const std::string& folder);

/// Throws IoError.
void write_task_launch(const TaskLaunch& record, const std::string& folder);

}  // namespace qsmpc::harness
