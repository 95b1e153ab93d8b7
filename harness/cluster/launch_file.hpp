// How the tasks of a campaign were started last, kept in its folder so that anybody who sees it can
// ask about them, end them, and start them again.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace qsmpc::harness {

struct TaskLaunch {
  std::int64_t launch = 0;               ///< 1, 2, …
  std::string options{};                 ///< of the launcher, as launch_options_text
  std::string record{};                  ///< the launcher's own; empty while it starts them
  int jobs = 0;                          ///< episodes at the same time, of each task; 0: one a core
  std::chrono::seconds lost_after{120};  ///< LeaseQueue::Options::lost_after
};

/// Nothing where no tasks were ever started. Throws IoError.
[[nodiscard]] std::optional<TaskLaunch> read_task_launch(const std::string& folder);

/// Throws IoError.
void write_task_launch(const TaskLaunch& record, const std::string& folder);

}  // namespace qsmpc::harness
