#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/campaign/plan/campaign_file.hpp"
#include "harness/campaign/plan/campaign_plan.hpp"
#include "harness/campaign/runner.hpp"
#include "harness/cli/campaign_driving.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/cli/campaign_tasks.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/fail_on.hpp"
#include "harness/cli/launch_arguments.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/plant_warnings.hpp"
#include "harness/cluster/start_tasks.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"
#include "harness/text/number_parse.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kCampaignHelp =
    "Runs many episodes: scenarios, settings and plants with many seeds, on all cores; writes a\n"
    "store (campaign.sqlite), statistics (campaign.json, CSV files), figures and a page "
    "(report.html).\n"
    "Started again on the same folder, it resumes where it stopped.";
constexpr const char* kCampaignExample =
    "Example: qsmpc campaign dubins_policies --out out/policies\n"
    "Its progress, from another terminal: qsmpc campaign status out/policies\n"
    "On two machines: qsmpc campaign dubins_policies --shard 1/2 --out out/one, --shard 2/2 on "
    "the\n"
    "other, then: qsmpc campaign merge out/one out/two --out out/policies\n"
    "On a cluster with a shared folder:\n"
    "         qsmpc campaign dubins_policies --on slurm --tasks 20 --out DIR";
constexpr std::int64_t kMostShards = 1'000'000;

struct CampaignArguments {
  std::string campaign;
  std::string out;
  std::string shard;
  bool dry_run = false;
  bool quiet = false;
  bool json = false;
  std::vector<std::string> fail_on = {"fault"};
  CampaignOptions options;
  LaunchOptions launch;          ///< `on` is empty if this process itself drives
  bool has_jobs = false;         ///< --jobs was given
  std::int64_t lease_seeds = 0;  ///< 0: not given
  std::int64_t lost_after = TaskLaunch{}.lost_after.count();  ///< s
};

/// Parses "I/N", 1 ≤ I ≤ N. Throws InputError on anything else.
Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const auto index = parse_integer<std::int64_t>(std::string_view(text).substr(0, slash));
    const auto count = parse_integer<std::int64_t>(std::string_view(text).substr(slash + 1));
    const bool both = index && count;
    if (both && *index >= 1 && *index <= *count && *count <= kMostShards) {
      return {.index = *index, .count = *count};
    }
  }
  throw InputError({.key = "--shard",
                    .found = text,
                    .expected = fmt::format("I/N with 1 <= I <= N <= {}, e.g. 1/4", kMostShards)});
}

/// Rejects options that are incompatible.
void check_launch(const CampaignArguments& arguments) {
  if (arguments.launch.on.empty()) {
    if (arguments.lease_seeds == 0 && arguments.launch == LaunchOptions{}) return;
    throw InputError({.key = "--on",
                      .found = "nothing, but options for tasks",
                      .expected = "local, ssh:HOSTS, ssh:@FILE or slurm"});
  }
  check_launch_options(arguments.launch);
  const auto refuse = [](const char* option, bool given) {
    if (!given) return;
    throw InputError(
        {.key = option, .found = "it together with --on", .expected = "one of the two"});
  };
  refuse("--shard", !arguments.shard.empty());
  refuse("--update", arguments.options.update);
  refuse("--retry-faults", arguments.options.retry_faults);
}

/// Simultaneous episodes per task; 0: as many as its machine has cores.
int jobs_of_tasks(const CampaignArguments& arguments) {
  if (arguments.has_jobs) return arguments.options.jobs;
  if (arguments.launch.on.starts_with("ssh:")) return 0;
  if (arguments.launch.on != "local") return 1;
  return std::max(1, available_threads() / launch_tasks(arguments.launch));
}

/// Drives the campaign by tasks: writes a plan into the folder, then proceeds as `resume` without a
/// previous launch.
int campaign_of_tasks(const Campaign& campaign, const std::string& folder,
                      const CampaignArguments& arguments) {
  const int jobs = jobs_of_tasks(arguments);
  const int tasks = launch_tasks(arguments.launch);
  if (arguments.launch.on == "local") {
    refuse_beyond_memory(campaign, arguments.campaign, jobs * tasks);
  }
  tell_plant_warnings(campaign);
  make_output_folder(folder);
  const std::string shared = std::filesystem::canonical(folder).string();
  plan_tasks(campaign, shared, arguments.lease_seeds,
             static_cast<std::int64_t>(std::max(jobs, 1)) * tasks);
  write_file(shared + "/" + kCampaignCopy, read_text_file(find_campaign(arguments.campaign)));
  const TaskLaunch request{.options = launch_options_text(arguments.launch),
                           .jobs = jobs,
                           .lost_after = std::chrono::seconds(arguments.lost_after)};
  return drive_with_tasks(
      shared, request,
      {.quiet = arguments.quiet, .json = arguments.json, .fail_on = arguments.fail_on});
}

int campaign_command(CampaignArguments& arguments) {
  check_launch(arguments);
  const Campaign campaign = load_campaign(arguments.campaign);
  if (!arguments.shard.empty()) arguments.options.shard = parse_shard(arguments.shard);
  if (arguments.dry_run) {
    print_result(arguments.json ? campaign_plan_json(campaign) : campaign_plan_text(campaign));
    return kDone;
  }
  const std::string folder =
      arguments.out.empty() ? default_folder(campaign.name, "campaign") : arguments.out;
  if (!arguments.launch.on.empty()) return campaign_of_tasks(campaign, folder, arguments);
  refuse_beyond_memory(campaign, arguments.campaign, arguments.options.jobs);
  refuse_unfinished_tasks(folder);
  tell_plant_warnings(campaign);
  const CampaignProgress end =
      drive_campaign(campaign, folder, arguments.options, {.quiet = arguments.quiet});
  write_file(folder + "/" + kCampaignCopy, read_text_file(find_campaign(arguments.campaign)));
  const CampaignStatistics statistics = write_campaign_results(folder);
  print_campaign_results(statistics, folder, arguments.json);
  if (end.done < end.total) {
    std::cerr << fmt::format(
        "qsmpc: interrupted; {} of {} episodes are done and kept; run the same command again to "
        "resume\n",
        end.done, end.total);
    return kInterruptedExit;
  }
  return asked_to_tell(arguments.fail_on, statistics) ? kToldFailure : kDone;
}

void add_tasks_options(CLI::App& command, CampaignArguments& arguments) {
  constexpr std::int64_t kLongest = 86'400;
  command.add_option(
      "--on", arguments.launch.on,
      "drive with tasks that share the output folder: local, ssh:HOSTS, ssh:@FILE or slurm");
  command.add_option("--tasks", arguments.launch.tasks, "with --on: number of tasks; default: 1")
      ->check(CLI::Range(1, kMostTasks));
  command
      .add_option("--lease", arguments.lease_seeds,
                  "with --on: number of seeds a task takes at a time; default: depends on the "
                  "number of seeds")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}));
  command
      .add_option("--lost-after", arguments.lost_after,
                  "with --on: seconds without a sign of life from a task before others take over "
                  "its work; default: 120")
      ->check(CLI::Range(std::int64_t{1}, kLongest));
  add_launch_options(command, arguments.launch);
}

void add_campaign_options(CLI::App& command, CampaignArguments& arguments) {
  CampaignOptions& options = arguments.options;
  command.add_option("campaign", arguments.campaign,
                     "a campaign file, or the name of a shipped one");
  command
      .add_option("--jobs", options.jobs,
                  "number of simultaneous episodes; default: one per core; affects only timings")
      ->check(CLI::Range(1, kMostAtOnce));
  command.add_option("--shard", arguments.shard,
                     "I/N: only every N-th seed, starting with the I-th, for one of N machines");
  command.add_option("--out", arguments.out, "output folder; default: out/NAME-campaign");
  command.add_flag("--dry-run", arguments.dry_run,
                   "check the campaign and show what would be driven");
  command.add_flag("--update", options.update,
                   "resume in the folder of a campaign that has changed: keep the episodes that "
                   "both versions ask for, remove the others");
  command.add_flag("--retry-faults", options.retry_faults, "drive the faulted episodes again");
  add_fail_on_option(command, arguments.fail_on,
                     {"collision", "left_bounds", kFailOnUnsafe, "timeout", "fault",
                      kFailOnRiskExceeded, kFailOnExceeded, "none"});
  command.add_flag("--quiet", arguments.quiet, "no progress display");
  command.add_flag("--json", arguments.json, "print campaign.json instead of the table");
}

}  // namespace

void add_campaign_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("campaign", kCampaignHelp);
  command->footer(kCampaignExample);
  const auto arguments = std::make_shared<CampaignArguments>();
  arguments->options.jobs = std::min(kMostAtOnce, available_threads());
  add_campaign_options(*command, *arguments);
  add_tasks_options(*command, *arguments);
  add_campaign_status_command(*command, exit_code);
  add_campaign_merge_command(*command, exit_code);
  add_campaign_tasks_commands(*command, exit_code);
  // The callback is also called for the subcommands.
  command->callback([command, arguments, &exit_code] {
    if (!command->get_subcommands().empty()) return;
    if (arguments->campaign.empty()) throw CLI::RequiredError("campaign");
    arguments->has_jobs = command->count("--jobs") > 0;
    exit_code = campaign_command(*arguments);
  });
}

}  // namespace qsmpc::harness
