#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/campaign/runner.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/cli/artefacts.hpp"
#include "harness/cli/campaign_driving.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/contest_files.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/plant_warnings.hpp"
#include "harness/contest/contest_file.hpp"
#include "harness/contest/contest_results.hpp"
#include "harness/contest/tuning.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kContestHelp =
    "Compares controllers on the same maps, plants, noise and seeds, each with settings that the\n"
    "same search chose on other seeds; writes a page (contest.html), contest.json, contest.csv, a\n"
    "figure, and the files that qsmpc campaign writes for the drives.\n"
    "Started again on the same folder, it resumes where it stopped.";
constexpr const char* kContestExample =
    "Example: qsmpc contest rivals --out out/rivals\n"
    "Its progress, from another terminal: qsmpc campaign status out/rivals";

struct ContestArguments {
  std::string contest;
  std::string out;
  int jobs = 1;
  bool update = false;
  bool dry_run = false;
  bool quiet = false;
  bool json = false;
};

/// One of a contest's parts.
struct ContestPart {
  const Campaign& drives;
  std::string folder;
  std::string label;
  int jobs = 1;
};

/// Returns whether the whole part has been driven.
bool drive_part(const ContestPart& part, const ContestArguments& arguments) {
  const CampaignProgress end =
      drive_campaign(part.drives, part.folder, {.jobs = part.jobs, .update = arguments.update},
                     {.label = part.label, .quiet = arguments.quiet});
  if (end.done == end.total) return true;
  std::cerr << fmt::format(
      "qsmpc: interrupted while {}; {} of {} drives are done and kept; run the same command again "
      "to resume\n",
      part.label, end.done, end.total);
  return false;
}

/// Returns nothing if interrupted.
std::optional<TuningResult> tune(const LoadedContest& loaded, const std::string& folder,
                                 const ContestArguments& arguments) {
  if (loaded.search.variants.empty()) return untuned(loaded.contest);
  const std::string part = folder + "/" + kTuningFolder;
  if (!drive_part(
          {.drives = loaded.search, .folder = part, .label = "tuning", .jobs = arguments.jobs},
          arguments)) {
    return std::nullopt;
  }
  const StoreReader store(part);
  store.verify();
  return tuned(loaded.contest, store);
}

int contest_command(const ContestArguments& arguments) {
  const LoadedContest loaded = load_contest(arguments.contest);
  if (arguments.dry_run) {
    print_result(arguments.json ? contest_plan_json(loaded) : contest_plan_text(loaded));
    return kDone;
  }
  for (const Campaign* part : {&loaded.search, &loaded.drives}) {
    refuse_beyond_memory(*part, arguments.contest, arguments.jobs);
  }
  const std::string folder =
      arguments.out.empty() ? default_folder(loaded.contest.name, "contest") : arguments.out;
  make_output_folder(folder);
  tell_plant_warnings(loaded.drives);
  const std::optional<TuningResult> tuning = tune(loaded, folder, arguments);
  if (!tuning) return kInterruptedExit;
  const Campaign drives = chosen_drives(loaded.contest, tuning->choice);
  const bool driven = drive_part(
      {.drives = drives, .folder = folder, .label = "driving", .jobs = arguments.jobs}, arguments);
  // One drive at a time: parallel drives would distort its times.
  const Campaign timed = timed_drives(loaded.contest, tuning->choice);
  const bool is_timed =
      driven &&
      drive_part({.drives = timed, .folder = folder + "/" + kTimingFolder, .label = "timing"},
                 arguments);
  write_file(folder + "/" + kContestCopy, read_text_file(find_contest(arguments.contest)));
  const ContestResults results = write_contest_files(loaded.contest, *tuning, folder, is_timed);
  print_result(arguments.json ? contest_json(results)
                              : contest_table(results) + contest_files_text(folder));
  return driven && is_timed ? kDone : kInterruptedExit;
}

}  // namespace

void add_contest_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("contest", kContestHelp);
  command->footer(kContestExample);
  const auto arguments = std::make_shared<ContestArguments>();
  arguments->jobs = std::min(kMostAtOnce, available_threads());
  command->add_option("contest", arguments->contest, "a contest file, or the name of a shipped one")
      ->required();
  command
      ->add_option(
          "--jobs", arguments->jobs,
          "number of simultaneous drives; default: one per core; timed drives always run alone")
      ->check(CLI::Range(1, kMostAtOnce));
  command->add_option("--out", arguments->out, "output folder; default: out/NAME-contest");
  command->add_flag("--dry-run", arguments->dry_run,
                    "check the contest and show what would be driven");
  command->add_flag("--update", arguments->update,
                    "resume in the folder of a contest that has changed: keep the drives that both "
                    "versions ask for, remove the others");
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->add_flag("--json", arguments->json, "print contest.json instead of the table");
  command->callback([arguments, &exit_code] { exit_code = contest_command(*arguments); });
}

}  // namespace qsmpc::harness
