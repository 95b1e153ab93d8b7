#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_file.hpp"
#include "harness/campaign/plan/campaign_plan.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/scenario_arguments.hpp"
#include "harness/contest/contest_file.hpp"
#include "harness/doctor/diagnosis.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_check.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/scenario_warnings.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

using Errors = std::vector<InputError::Where>;

/// The verdict on a scenario, campaign or contest file.
struct FileVerdict {
  std::string file;
  Errors errors{};
  std::vector<std::string> warnings{};  ///< warnings about a valid scenario
  std::optional<Campaign> campaign{};   ///< if it is a valid one
  std::optional<LoadedContest> contest{};
};

FileVerdict verdict_on_scenario(const std::string& file,
                                const std::vector<std::string>& overrides) {
  FileVerdict verdict{.file = file, .errors = validate_scenario_file(file, overrides)};
  if (!verdict.errors.empty()) return verdict;
  try {
    const Scenario scenario = load_scenario(file, overrides);
    if (const auto problem = plant_problem(scenario, file, overrides)) {
      verdict.errors.push_back(*problem);
      return verdict;
    }
    verdict.warnings = scenario_warnings(scenario);
    for (std::string& warning : plant_warnings(scenario)) {
      verdict.warnings.push_back(std::move(warning));
    }
  } catch (const InputError& error) {
    verdict.errors.push_back(error.where());  // the file has changed since
  }
  return verdict;
}

FileVerdict verdict_on_contest(const std::string& file) {
  try {
    return {.file = file, .contest = load_contest(file)};
  } catch (const InputError& error) {
    Errors errors = validate_contest_file(file);
    if (errors.empty()) errors.push_back(error.where());  // the file has changed since
    return {.file = file, .errors = std::move(errors)};
  }
}

FileVerdict verdict_on(const std::string& file, const std::vector<std::string>& overrides) {
  const bool is_contest = is_contest_file(file);
  if (!is_contest && !is_campaign_file(file)) return verdict_on_scenario(file, overrides);
  if (!overrides.empty()) {
    return {.file = file,
            .errors = {{.file = file,
                        .key = "--set",
                        .found = "a campaign or a contest",
                        .expected = "a scenario; theirs are changed by their own files"}}};
  }
  if (is_contest) return verdict_on_contest(file);
  try {
    return {.file = file, .campaign = load_campaign(file)};
  } catch (const InputError& error) {
    Errors errors = validate_campaign_file(file);
    if (errors.empty()) errors.push_back(error.where());  // the file has changed since
    return {.file = file, .errors = std::move(errors)};
  }
}

std::string as_text(const FileVerdict& verdict) {
  std::string text;
  for (const InputError::Where& error : verdict.errors) {
    text += InputError(error).what() + std::string("\n");
  }
  if (!text.empty()) return text;
  for (const std::string& warning : verdict.warnings) {
    text += verdict.file + ": warning: " + warning + "\n";
  }
  std::string size;
  if (verdict.campaign) size = campaign_size_text(*verdict.campaign) + ", ";
  if (verdict.contest) size = contest_size_text(*verdict.contest) + ", ";
  return text + verdict.file + ": " + size + "ok\n";
}

nlohmann::ordered_json as_json(const FileVerdict& verdict) {
  nlohmann::ordered_json json;
  json["file"] = verdict.file;
  json["ok"] = verdict.errors.empty();
  if (verdict.campaign) {
    json["campaign"] = {{"name", verdict.campaign->name},
                        {"variants", verdict.campaign->variants.size()},
                        {"seeds", verdict.campaign->seeds.size()},
                        {"episodes", verdict.campaign->episodes()}};
  }
  if (verdict.contest) {
    const Contest& contest = verdict.contest->contest;
    json["contest"] = {{"name", contest.name},
                       {"controllers", contest.controllers.size()},
                       {"cells", contest.cells().size()},
                       {"seeds", contest.seeds.size()},
                       {"drives", verdict.contest->drives.episodes()}};
  }
  json["errors"] = nlohmann::ordered_json::array();
  for (const InputError::Where& error : verdict.errors) {
    json["errors"].push_back({{"file", error.file},
                              {"line", error.line},
                              {"key", error.key},
                              {"found", error.found},
                              {"expected", error.expected}});
  }
  json["warnings"] = verdict.warnings;
  return json;
}

struct ValidateArguments {
  std::vector<std::string> files;
  std::vector<std::string> overrides;
  bool json = false;
};

int validate(const ValidateArguments& arguments) {
  bool all_valid = true;
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  std::string text;
  for (const std::string& file : arguments.files) {
    const FileVerdict verdict = verdict_on(file, arguments.overrides);
    all_valid = all_valid && verdict.errors.empty();
    text += as_text(verdict);
    results.push_back(as_json(verdict));
  }
  // As documented, one file gives one object; several give an array.
  const auto& value = results.size() == 1 ? results.front() : results;
  print_result(arguments.json ? json_text(value) : text);
  return all_valid ? kDone : kBadInput;
}

}  // namespace

void add_validate_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "validate", "Checks scenario, campaign and contest files without running them.");
  command->footer("Example: qsmpc validate my_scenario.yaml");
  const auto arguments = std::make_shared<ValidateArguments>();
  command
      ->add_option("files", arguments->files,
                   "scenario, campaign or contest files, or names of shipped ones")
      ->required();
  add_set_option(*command, arguments->overrides);
  command->add_flag("--json", arguments->json, "print JSON");
  command->callback([arguments, &exit_code] { exit_code = validate(*arguments); });
}

}  // namespace qsmpc::harness
