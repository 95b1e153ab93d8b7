// The report of each task, in its own folder within the campaign's.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/cluster/lease_queue.hpp"

namespace qsmpc::harness {

enum class TaskWord {
  kWorking,  ///< or ended without a report, e.g. killed
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
  double seconds = 0.0;       ///< time at work, by its own clock
  std::int64_t beat = 0;      ///< changes while it works
};

/// FOLDER/cluster/tasks/TASK-START.
[[nodiscard]] std::string task_folder(const std::string& folder, const LeaseHolder& holder);

/// Creates the folder of the next start of a task, for its store only. Sets `holder.start`. Throws
/// IoError.
void make_task_folder(const std::string& folder, LeaseHolder& holder);

/// Throws IoError.
void write_task_report(const std::string& folder, const TaskReport& report);

/// All reports, by task and start. Tasks without a report are skipped. Throws IoError.
[[nodiscard]] std::vector<TaskReport> task_reports(const std::string& folder);

/// The tasks that may be at work: those of `reports` that say so and are of launch `launch` or
/// later. All tasks of earlier launches have ended.
[[nodiscard]] std::vector<TaskReport> maybe_working(const std::vector<TaskReport>& reports,
                                                    std::int64_t launch);

/// Those of `suspects` that show signs of work within `patience`, by the clock of this process.
/// Returns early once all have. `sleep` is called between polls. Throws IoError, and what `sleep`
/// throws.
[[nodiscard]] std::vector<TaskReport> found_working(const std::string& folder,
                                                    std::vector<TaskReport> suspects,
                                                    std::chrono::steady_clock::duration patience,
                                                    const std::function<void()>& sleep);

}  // namespace qsmpc::harness
