#include "harness/cluster/start_tasks.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "harness/campaign/store/store_schema.hpp"
#include "harness/cluster/task_report.hpp"
#include "harness/errors.hpp"
#include "harness/text/printable.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {
namespace {

/// The number of tasks of `launch` that are waiting or running, as far as its launcher knows.
std::ptrdiff_t count_unended(Launcher& launcher, const TaskLaunch& launch) {
  return std::ranges::count_if(launcher.states(launch.record), [](const TaskState& task) {
    return task.condition == TaskCondition::kWaiting || task.condition == TaskCondition::kRunning;
  });
}

/// Whether any task shows signs of work. A launcher that stays cannot know the state of tasks whose
/// conductor ran on another machine, which may have failed.
bool any_gives_signs(const std::string& folder, const TaskLaunch& launch) {
  const auto sleep = [] {
    check_interrupts();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  };
  const auto suspects = maybe_working(task_reports(folder), launch.launch);
  return !found_working(folder, suspects, launch.lost_after, sleep).empty();
}

void refuse_working_tasks(const std::string& folder, const TaskLaunch& launch) {
  if (launch.record.empty()) return;
  const auto launcher = launcher_of(launch.record);
  const std::ptrdiff_t count = count_unended(*launcher, launch);
  if (count == 0 || (launcher->stays() && !any_gives_signs(folder, launch))) return;
  throw IoError(
      fmt::format("{}: {} of its tasks {} waiting or running; use qsmpc campaign status or cancel "
                  "on this folder",
                  printable(folder, 400), count, count == 1 ? "is" : "are"));
}

}  // namespace

void plan_tasks(const Campaign& campaign, const std::string& folder, std::int64_t lease_seeds,
                std::int64_t at_once) {
  const std::string path = cluster_path(folder, kPlanFile);
  if (!has_lease_plan(folder)) {
    std::error_code ignored;
    if (std::filesystem::exists(folder + "/" + kStoreFile, ignored)) {
      throw InputError({.file = folder,
                        .key = "--on",
                        .found = "a campaign of one process",
                        .expected = "another folder; this one resumes without --on"});
    }
    const std::int64_t size =
        lease_seeds > 0 ? lease_seeds : default_lease_seeds(campaign.seeds.size(), at_once);
    write_lease_plan(lease_plan(campaign, size), folder);
    return;
  }
  const LeasePlan plan = read_lease_plan(folder);
  const LeasePlan asked = lease_plan(campaign, plan.lease_seeds);
  refuse_other_campaign(path, plan.identity, asked.identity, "; use another folder");
  if (lease_seeds > 0 && lease_seeds != plan.lease_seeds) {
    throw InputError({.file = path,
                      .key = "--lease",
                      .found = fmt::format("leases of {} seeds", plan.lease_seeds),
                      .expected = fmt::format("{}; use another folder", lease_seeds)});
  }
}

StartedTasks start_tasks(const std::string& folder, TaskLaunch request,
                         const std::string& program) {
  const LaunchOptions options = launch_options_from_text(request.options);
  StartedTasks started{.launcher = make_launcher(options), .launch = std::move(request)};
  const TaskLaunch before = read_task_launch(folder).value_or(TaskLaunch{});
  refuse_working_tasks(folder, before);
  TaskLaunch& launch = started.launch;
  launch.launch = before.launch + 1;
  launch.record.clear();
  // Must be written before the first task reads it.
  write_task_launch(launch, folder);
  LaunchRequest tasks{.folder = folder,
                      .worker = {program, "campaign", "work", folder},
                      .gather = {program, "campaign", "gather", folder, "--quiet"},
                      .tasks = launch_tasks(options),
                      .jobs = std::max(launch.jobs, 1)};
  if (launch.jobs > 0) {
    tasks.worker.insert(tasks.worker.end(), {"--jobs", std::to_string(launch.jobs)});
  }
  launch.record = started.launcher->start(tasks);
  write_task_launch(launch, folder);
  return started;
}

void cancel_tasks(const std::string& folder) {
  const std::optional<TaskLaunch> launch = read_task_launch(folder);
  if (!launch || launch->record.empty()) {
    throw InputError({.file = folder,
                      .found = "no record of started tasks",
                      .expected = "the folder of qsmpc campaign FILE --on …"});
  }
  launcher_of(launch->record)->cancel(launch->record);
}

}  // namespace qsmpc::harness
