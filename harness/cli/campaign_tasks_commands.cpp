// The commands that take the folder of a campaign driven by tasks.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/campaign/store/folder_lock.hpp"
#include "harness/cli/campaign_driving.hpp"
#include "harness/cli/campaign_tasks.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/start_tasks.hpp"
#include "harness/cluster/worker.hpp"
#include "harness/errors.hpp"
#include "harness/text/printable.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

struct WorkArguments {
  std::string folder;
  WorkerOptions options;
};

int work(WorkArguments& arguments) {
  const LeasePlan plan = read_lease_plan(arguments.folder);
  const Campaign campaign = planned_campaign(plan, arguments.folder);
  refuse_beyond_memory(campaign, arguments.folder, arguments.options.jobs);
  const InterruptPatience patience(2);  // the first interrupt lets episodes finish
  arguments.options.should_stop = [] { return interrupts() > 0; };
  arguments.options.should_hurry = [] { return interrupts() > 1; };
  const WorkerEnd end = run_worker(plan, campaign, arguments.folder, arguments.options);
  std::cerr << fmt::format(
      "qsmpc: task {} drove {} episodes; {}\n", arguments.options.task, end.episodes,
      end.all_finished ? "all episodes are done" : "stopped, and its leases have been given back");
  return end.all_finished ? kDone : kInterruptedExit;
}

void add_work_command(CLI::App& campaign, int& exit_code) {
  CLI::App* command = campaign.add_subcommand(
      "work",
      "Runs one task of a campaign that several tasks drive; --on starts these. Started by hand, "
      "on any machine that has the folder, it helps the others.");
  command->footer("Example: qsmpc campaign work out/policies --task 100");
  const auto arguments = std::make_shared<WorkArguments>();
  arguments->options.jobs = std::min(kMostAtOnce, available_threads());
  command->add_option("folder", arguments->folder, "folder of a campaign started with --on")
      ->required();
  command->add_option("--task", arguments->options.task, "number of the task")
      ->check(CLI::Range(1, 1'000'000'000));
  command
      ->add_option("--jobs", arguments->options.jobs,
                   "number of simultaneous episodes; default: one per core")
      ->check(CLI::Range(1, kMostAtOnce));
  command->callback([arguments, &exit_code] { exit_code = work(*arguments); });
}

/// The canonical path of a campaign's folder, the same for all tasks. Throws InputError if it has
/// no plan.
std::string planned_folder(const std::string& folder) {
  (void)read_lease_plan(folder);
  return std::filesystem::canonical(folder).string();
}

struct TasksArguments {
  std::string folder;
  TasksTalk talk;
};

/// Adds the options of a command that takes the folder and produces a campaign's results.
std::shared_ptr<TasksArguments> add_tasks_options(CLI::App& command) {
  auto arguments = std::make_shared<TasksArguments>();
  command.add_option("folder", arguments->folder, "folder of a campaign started with --on")
      ->required();
  command.add_flag("--quiet", arguments->talk.quiet, "no progress display");
  command.add_flag("--json", arguments->talk.json, "print campaign.json instead of the table");
  return arguments;
}

void add_gather_command(CLI::App& campaign, int& exit_code) {
  CLI::App* command =
      campaign.add_subcommand("gather",
                              "Joins the episodes that the tasks of a campaign have driven and "
                              "writes the results so far, even if episodes are missing.");
  command->footer("Example: qsmpc campaign gather out/policies");
  const auto arguments = add_tasks_options(*command);
  command->callback([arguments, &exit_code] {
    const std::string folder = planned_folder(arguments->folder);
    const FolderLock lock(folder + "/" + kClusterFolder);
    exit_code = gather_and_tell(folder, arguments->talk, false);
  });
}

void add_resume_command(CLI::App& campaign, int& exit_code) {
  CLI::App* command =
      campaign.add_subcommand("resume",
                              "Starts tasks again for the missing episodes of a campaign, with the "
                              "same launcher and options as the last start.");
  command->footer("Example: qsmpc campaign resume out/policies");
  const auto arguments = add_tasks_options(*command);
  command->callback([arguments, &exit_code] {
    const std::string folder = planned_folder(arguments->folder);
    (void)planned_campaign(read_lease_plan(folder), folder);
    const auto launch = read_task_launch(folder);
    if (!launch) {
      throw InputError({.file = folder,
                        .found = "no record of started tasks",
                        .expected = "the folder of qsmpc campaign FILE --on …"});
    }
    exit_code = drive_with_tasks(folder, *launch, arguments->talk);
  });
}

void add_cancel_command(CLI::App& campaign, int& exit_code) {
  CLI::App* command = campaign.add_subcommand(
      "cancel", "Stops the tasks of a campaign; finished episodes are kept, and resume continues.");
  command->footer("Example: qsmpc campaign cancel out/policies");
  const auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "folder of a campaign started with --on")->required();
  command->callback([folder, &exit_code] {
    cancel_tasks(planned_folder(*folder));
    std::cerr << fmt::format(
        "qsmpc: the tasks have been told to stop; qsmpc campaign status {0} shows when they have, "
        "and qsmpc campaign resume {0} continues\n",
        printable(*folder, 400));
    exit_code = kDone;
  });
}

}  // namespace

void add_campaign_tasks_commands(CLI::App& campaign, int& exit_code) {
  add_work_command(campaign, exit_code);
  add_gather_command(campaign, exit_code);
  add_resume_command(campaign, exit_code);
  add_cancel_command(campaign, exit_code);
}

}  // namespace qsmpc::harness
