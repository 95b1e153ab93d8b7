#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/errors.hpp"
#include "harness/mismatch/parameter_fit.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "harness/text/json_text.hpp"
#include "harness/text/printable.hpp"
#include "harness/trace/trace_file.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kFitHelp =
    "Fits constants of the planner's model to what a plant did in recorded drives: minimises the\n"
    "errors of the model's prediction, period by period, without the disturbance.";
constexpr const char* kFitExample =
    "Example: qsmpc fit out/drive-0 out/drive-1 --parameter lag --parameter slip";

struct FitArguments {
  std::vector<std::string> folders;
  std::vector<std::string> parameters;
  bool json = false;
};

struct Drives {
  Scenario scenario;  // of the first
  PlantPeriods periods;
};

/// What drives must have in common, in words: their models may differ in all else.
std::string shape_of(const Scenario& scenario) {
  const models::SystemDescription system = system_of(scenario);
  std::string text = "states";
  for (const models::Coordinate& state : system.states) text += " " + state.name;
  text += ", inputs";
  for (const models::Coordinate& input : system.inputs) text += " " + input.name;
  return text + fmt::format(", a period of {} s", scenario.time_step);
}

/// A drive that counted twice would make the standard errors too small.
void refuse_repeated(const std::vector<std::string>& folders) {
  std::set<std::filesystem::path> seen;
  for (const std::string& folder : folders) {
    std::error_code error;
    const std::filesystem::path place = std::filesystem::canonical(folder, error);
    if (error) continue;  // reading it says why
    if (!seen.insert(place).second) {
      throw InputError({.file = folder,
                        .key = "folders",
                        .found = "the same drive a second time",
                        .expected = "each drive once"});
    }
  }
}

Drives read_drives(const std::vector<std::string>& folders) {
  refuse_repeated(folders);
  Drives drives;
  for (const std::string& folder : folders) {
    const Trace trace = read_folder(folder);
    if (&folder == &folders.front()) drives.scenario = trace.scenario;
    const std::string shape = shape_of(trace.scenario);
    const std::string first = shape_of(drives.scenario);
    if (shape != first) {
      throw InputError({.file = folder,
                        .key = "model",
                        .found = printable(shape, 400),
                        .expected = printable(first, 400) + ", as in the first drive"});
    }
    drives.periods.add(trace);
  }
  return drives;
}

/// The scenario key of a constant: users' systems have theirs in a mapping.
std::string key_of(const Scenario& scenario, const std::string& parameter) {
  const bool own = scenario.model.own.has_value() || !scenario.model.library.empty();
  return (own ? "model.parameters." : "model.") + parameter;
}

std::string fit_table(const Drives& drives, const ParameterFit& fit) {
  std::string text =
      fmt::format("{}: {} periods\n\n  {:<28}{:>14}{:>14}{:>12}\n", printable(drives.scenario.name),
                  drives.periods.ends.cols(), "constant", "in the drives", "fitted", "+-");
  for (const FittedParameter& parameter : fit.parameters) {
    text += fmt::format("  {:<28}{:>14.5g}{:>14.5g}{:>12.1e}\n", parameter.name, parameter.before,
                        parameter.fitted, parameter.deviation);
  }
  text += fmt::format("\nError of the model in a period, rms\n  {:<28}{:>14}{:>14}\n", "state",
                      "in the drives", "fitted");
  const models::SystemDescription system = system_of(drives.scenario);
  for (Eigen::Index i = 0; i < fit.rms_before.size(); ++i) {
    const models::Coordinate& state = system.states[static_cast<std::size_t>(i)];
    text += fmt::format("  {:<28}{:>14.2e}{:>14.2e}\n",
                        state.unit.empty() ? state.name : state.name + ", " + state.unit,
                        fit.rms_before[i], fit.rms_after[i]);
  }
  text += "\nTo drive with them:\n ";
  for (const FittedParameter& parameter : fit.parameters) {
    text +=
        fmt::format(" --set {}={:.5g}", key_of(drives.scenario, parameter.name), parameter.fitted);
  }
  return text + "\n";
}

std::string fit_json(const Drives& drives, const ParameterFit& fit) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const FittedParameter& parameter : fit.parameters) {
    parameters.push_back({{"key", key_of(drives.scenario, parameter.name)},
                          {"before", parameter.before},
                          {"fitted", parameter.fitted},
                          {"deviation", parameter.deviation}});
  }
  const auto list = [](const Eigen::VectorXd& values) {
    return std::vector<double>(values.begin(), values.end());
  };
  return json_text({{"scenario", drives.scenario.name},
                    {"periods", drives.periods.ends.cols()},
                    {"parameters", parameters},
                    {"rms", {{"before", list(fit.rms_before)}, {"after", list(fit.rms_after)}}}});
}

int fit(const FitArguments& arguments) {
  const Drives drives = read_drives(arguments.folders);
  const ParameterFit fit = fit_parameters(drives.scenario, arguments.parameters, drives.periods);
  print_result(arguments.json ? fit_json(drives, fit) : fit_table(drives, fit));
  return kDone;
}

}  // namespace

void add_fit_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("fit", kFitHelp);
  command->footer(kFitExample);
  const auto arguments = std::make_shared<FitArguments>();
  command
      ->add_option("folders", arguments->folders,
                   "folders of drives with the same states and inputs")
      ->required();
  command
      ->add_option("--parameter", arguments->parameters,
                   "NAME: a constant of the model to fit; may be repeated")
      ->required()
      ->allow_extra_args(false);
  command->add_flag("--json", arguments->json, "print JSON");
  command->callback([arguments, &exit_code] { exit_code = fit(*arguments); });
}

}  // namespace qsmpc::harness
