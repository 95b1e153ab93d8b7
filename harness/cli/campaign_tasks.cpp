#include "harness/cli/campaign_tasks.hpp"

#include <chrono>
#include <iostream>
#include <thread>

#include <fmt/format.h>

#include "harness/campaign/store/folder_lock.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/progress.hpp"
#include "harness/cluster/cluster_status.hpp"
#include "harness/cluster/gather.hpp"
#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/start_tasks.hpp"
#include "harness/errors.hpp"
#include "harness/files/installation.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

std::string tasks_lock_folder(const std::string& folder) { return folder + "/" + kClusterFolder; }

/// Polls for finished episodes, and shows the progress.
class TasksProgress {
 public:
  TasksProgress(std::string folder, bool quiet)
      : folder_(std::move(folder)), bar_("driving", quiet) {
    finished_.look(folder_);
    now_.total = read_lease_plan(folder_).episodes();
    before_ = finished_.count();
  }

  /// Shows the progress at most once a second.
  void show_at_times() {
    constexpr auto kPeriod = std::chrono::seconds(1);
    if (Clock::now() < next_) return;
    next_ = Clock::now() + kPeriod;
    show();
  }

  void show() {
    finished_.look(folder_);
    now_.done = finished_.count();
    now_.fresh = now_.done - before_;
    now_.outcomes = finished_.outcomes();
    now_.elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    bar_.update(now_.done, now_.total, progress_note(now_));
  }

 private:
  const std::string folder_;
  Progress bar_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point next_{};
  FinishedEpisodes finished_;
  CampaignProgress now_;
  std::int64_t before_ = 0;
};

/// Waits for the tasks; each Ctrl-C is forwarded to them once.
void wait_for_tasks(const StartedTasks& started, const std::string& folder, bool quiet) {
  const InterruptPatience patience(2);
  TasksProgress progress(folder, quiet);
  int handed_on = 0;
  started.launcher->wait(started.launch.record, [&] {
    progress.show_at_times();
    if (interrupts() == handed_on) return true;
    ++handed_on;
    return false;
  });
  progress.show();
}

void tell_failures(const StartedTasks& started, const std::string& folder) {
  for (const TaskState& task : started.launcher->states(started.launch.record)) {
    if (task.condition != TaskCondition::kFailed && task.condition != TaskCondition::kLost)
      continue;
    std::cerr << fmt::format("qsmpc: task {} {}{}{}; see its output in {}\n", task.task,
                             task_condition_name(task.condition),
                             task.where.empty() ? "" : " on " + printable(task.where),
                             task.note.empty() ? "" : ": " + printable(task.note, 400),
                             task_log_path(folder, task.task));
  }
}

}  // namespace

int gather_and_tell(const std::string& folder, const TasksTalk& talk, bool tasks_have_ended) {
  GatherOptions options{.tasks_have_ended = tasks_have_ended};
  options.on_watch = [&](const std::string& tasks, double seconds) {
    if (talk.quiet) return;
    std::cerr << fmt::format("qsmpc: checking for up to {} whether {} still run\n",
                             duration_text(seconds), tasks);
  };
  options.sleep = [] {
    check_interrupts();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  };
  const Gathered gathered = gather_tasks(folder, options);
  const CampaignStatistics statistics = write_campaign_results(folder);
  print_campaign_results(statistics, folder, talk.json);
  if (gathered.episodes < gathered.total) {
    std::cerr << fmt::format(
        "qsmpc: {} of {} episodes are missing; finished ones are kept, and qsmpc campaign resume "
        "{} continues\n",
        gathered.total - gathered.episodes, gathered.total, printable(folder, 400));
    return kInterruptedExit;
  }
  return asked_to_tell(talk.fail_on, statistics) ? kToldFailure : kDone;
}

int drive_with_tasks(const std::string& folder, const TaskLaunch& request, const TasksTalk& talk) {
  const FolderLock lock(tasks_lock_folder(folder));
  const StartedTasks started = start_tasks(folder, request, own_object_file());
  if (!started.launcher->stays()) {
    if (!talk.quiet) {
      const int tasks = launch_tasks(launch_options_from_text(request.options));
      std::cerr << fmt::format(
          "qsmpc: {} task{} submitted; qsmpc campaign status, cancel and resume work on {}\n",
          tasks, tasks == 1 ? "" : "s", printable(folder, 400));
    }
    return kDone;
  }
  wait_for_tasks(started, folder, talk.quiet);
  tell_failures(started, folder);
  return gather_and_tell(folder, talk, true);
}

void refuse_unfinished_tasks(const std::string& folder) {
  if (!has_lease_plan(folder) || is_gathered(folder)) return;
  throw InputError({.file = folder,
                    .found = "a campaign whose tasks have not finished",
                    .expected = "qsmpc campaign resume, or another folder"});
}

}  // namespace qsmpc::harness
