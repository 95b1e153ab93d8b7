// What each task says of itself, in its own folder within the campaign's.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/cluster/lease_queue.hpp"

namespace qsmpc::harness {

enum class TaskWord {
  kWorking,  ///< or ended without another word, e.g. killed
  kDone,     ///< nothing was left to do
  kStopped,  ///< asked to stop
  kFailed
};

/// "working", "done", "stopped" or "failed".
[[nodiscard]] const char* task_word(TaskWord word);

struct TaskReport {
  LeaseHolder holder{};
  TaskWord word = TaskWord::kWorking;
  std::string note{};         ///< why it failed
  std::int64_t episodes = 0;  ///< driven by this start of the task
  double seconds = 0.0;       ///< that it has worked, by its own clock
  std::int64_t beat = 0;      ///< changes as long as it works
};

/// FOLDER/cluster/tasks/TASK-START.
[[nodiscard]] std::string task_folder(const std::string& folder, const LeaseHolder& holder);

/// Makes the folder of the next start of a task; its store is there and nobody else's. Sets
/// `holder.start`. Throws IoError.
void make_task_folder(const std::string& folder, LeaseHolder& holder);

/// Throws IoError.
void write_task_report(const std::string& folder, const TaskReport& report);

/// By task and start. Tasks that have said nothing yet are left out. Throws IoError.
[[nodiscard]] std::vector<TaskReport> task_reports(const std::string& folder);

/// Of `reports`, those that say that they work and are of the launch `launch` or later: the tasks
/// that may be at work. All tasks of earlier launches have ended.
[[nodiscard]] std::vector<TaskReport> maybe_working(const std::vector<TaskReport>& reports,
                                                    std::int64_t launch);

/// Those of `suspects` that show within `patience` that they work, by the clock of this process.
/// Ends early once all have. `sleep` is called between looks. Throws IoError, and what `sleep`
/// does.
[[nodiscard]] std::vector<TaskReport> found_working(const std::string& folder,
                                                    std::vector<TaskReport> suspects,
                                                    std::chrono::steady_clock::duration patience,
                                                    const std::function<void()>& sleep);

}  // namespace qsmpc::harness
