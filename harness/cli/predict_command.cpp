#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "controller/laws/law_propagator.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/progress.hpp"
#include "harness/cli/result_folder.hpp"
#include "harness/cli/scenario_arguments.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/prediction/input_table.hpp"
#include "harness/prediction/law_table.hpp"
#include "harness/prediction/prediction_file.hpp"
#include "harness/prediction/prediction_json.hpp"
#include "harness/prediction/prediction_report.hpp"
#include "harness/prediction/prediction_table.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/scenario_warnings.hpp"
#include "harness/scenario/value_checks.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kPredictHelp =
    "Plans once from the scenario's initial belief, without a plant, and writes the measures "
    "along\n"
    "the horizon, their error and their certificates: predict.h5, predict.json and scenario.yaml.";
constexpr const char* kPredictExample =
    "Examples: qsmpc predict dubins_corridor --steps 6 --monte-carlo 100000\n"
    "          qsmpc predict dubins_corridor --inputs my_inputs.csv --json\n"
    "          qsmpc predict dubins_prediction --methods unscented,mixture\n"
    "FILE has one line per stage and one number per input, separated by commas; a first line may\n"
    "name the inputs. A certificate of stage k applies to this plan followed for k stages.";
// Most paths; the progress shows their numbers as 32-bit integers.
constexpr std::int64_t kMostSamples = 1'000'000'000;
/// Number of paths if methods are compared and --monte-carlo is not given.
constexpr std::int64_t kComparedSamples = 1'000'000;
constexpr const char* kAllMethods = "all";

struct PredictArguments {
  std::string scenario;
  std::vector<std::string> overrides;
  std::string inputs;
  std::optional<int> steps;
  std::int64_t samples = 0;
  std::vector<std::string> methods;
  std::vector<int> at;
  std::optional<std::uint64_t> seed;
  std::string out;
  bool force = false;
  bool quiet = false;
  bool json = false;
};

/// The inputs from the file, if one is given; sets the horizon of `scenario` to the number of
/// predicted steps.
std::optional<Eigen::MatrixXd> take_inputs(const PredictArguments& arguments, Scenario& scenario) {
  if (arguments.steps) scenario.controller.horizon = *arguments.steps;
  if (arguments.inputs.empty()) return std::nullopt;
  const Scenario::Controller& controller = scenario.controller;
  Eigen::MatrixXd inputs = read_input_table(
      arguments.inputs,
      {.inputs = model_of(scenario)->description().inputs,
       .bounds = {.lower = controller.input_lower, .upper = controller.input_upper},
       .stages = arguments.steps});
  scenario.controller.horizon = static_cast<int>(inputs.cols());
  return inputs;
}

/// The methods to compare, in the order of the table, each once.
std::vector<std::string> chosen_methods(const std::vector<std::string>& asked) {
  std::vector<std::string> chosen;
  for (const controller::LawMethod& method : controller::law_methods()) {
    const bool is_asked = std::ranges::any_of(
        asked, [&](const std::string& name) { return name == method.name || name == kAllMethods; });
    if (is_asked) chosen.push_back(method.name);
  }
  return chosen;
}

/// Number of simulated paths; 0 for none.
std::int64_t simulated_paths(const PredictArguments& arguments) {
  if (arguments.methods.empty()) return arguments.samples;
  if (arguments.samples == 0) return kComparedSamples;
  if (arguments.samples < kKeptPaths) {
    throw InputError({.key = "--monte-carlo",
                      .found = std::to_string(arguments.samples),
                      .expected = fmt::format("at least {} paths with --methods", kKeptPaths)});
  }
  return arguments.samples;
}

void check_stages(const std::vector<int>& stages, int horizon) {
  for (const int stage : stages) {
    if (stage <= horizon) continue;
    throw InputError({.key = "--at",
                      .found = std::to_string(stage),
                      .expected = fmt::format("stages from 1 to {}", horizon)});
  }
}

std::string files_table(const std::string& folder) {
  std::string text;
  for (const auto& [what, file] : {std::pair("numbers", kPredictionNumbersFile),
                                   std::pair("particles, policy", kPredictionFile)}) {
    text += fmt::format("  {:<20} {}/{}\n", what, folder, file);
  }
  return text;
}

/// Reports on standard error what must not be overlooked, and returns the exit code.
int conclude(const PredictionReport& report) {
  if (const std::vector<int> stages = contradicted_stages(report); !stages.empty()) {
    std::cerr << fmt::format(
        "qsmpc: internal error: more simulated paths are unsafe than the certificate allows, at "
        "stage {}\n",
        fmt::join(stages, ", "));
    return kInternalError;
  }
  if (report.interrupted) {
    std::cerr << fmt::format("qsmpc: interrupted; the files hold the prediction without the {}\n",
                             report.monte_carlo ? "comparison of methods" : "simulation");
    return kInterruptedExit;
  }
  return kDone;
}

int predict(const PredictArguments& arguments) {
  Scenario scenario = load_scenario(arguments.scenario, arguments.overrides);
  scenario.seed = arguments.seed.value_or(scenario.seed);
  refuse_motion(scenario, arguments.scenario, arguments.overrides, "predict");
  print_warnings(scenario_warnings(scenario));
  PredictionOptions options{.inputs = take_inputs(arguments, scenario),
                            .methods = chosen_methods(arguments.methods)};
  const std::int64_t samples = simulated_paths(arguments);
  check_stages(arguments.at, options.inputs ? static_cast<int>(options.inputs->cols())
                                            : certified_stages(decision_parts(scenario)));
  refuse_beyond_memory(scenario, arguments.scenario, arguments.overrides);
  const std::string folder = arguments.out.empty()
                                 ? default_folder(scenario.name, "predict", arguments.overrides)
                                 : arguments.out;
  settle_points(scenario, arguments.quiet);
  refuse_other_result(folder, scenario, arguments.force);
  make_output_folder(folder);

  Progress progress("simulating", arguments.quiet);
  options.monte_carlo = {.samples = samples,
                         .should_stop = [] { return interrupts() > 0; },
                         .on_progress =
                             [&](std::int64_t done, std::int64_t total) {
                               progress.update(static_cast<int>(done), static_cast<int>(total),
                                               "paths");
                             }};
  const InterruptPatience patience(2);  // the first interrupt skips the simulation
  const PredictionReport report = predict_scenario(scenario, options);
  write_prediction(report, folder);
  print_result(arguments.json ? prediction_json(report)
                              : prediction_table(report) + law_table(report, arguments.at) +
                                    files_table(folder));
  return conclude(report);
}

}  // namespace

void add_predict_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("predict", kPredictHelp);
  command->footer(kPredictExample);
  const auto arguments = std::make_shared<PredictArguments>();
  add_scenario_argument(*command, arguments->scenario);
  add_set_option(*command, arguments->overrides);
  command->add_option("--inputs", arguments->inputs,
                      "FILE (CSV): inputs to predict with; default: the planned ones");
  command
      ->add_option("--steps", arguments->steps,
                   "number of stages; default: the rows of --inputs, or the scenario's horizon")
      ->check(CLI::Range(1, kMostStages));
  command
      ->add_option("--monte-carlo", arguments->samples,
                   "number of paths of the model to simulate as a check of the certificates")
      ->check(CLI::Range(std::int64_t{1}, kMostSamples));
  std::vector<std::string> names{kAllMethods};
  for (const controller::LawMethod& method : controller::law_methods()) {
    names.push_back(method.name);
  }
  CLI::Option* methods =
      command
          ->add_option("--methods", arguments->methods,
                       "compare these methods of prediction with simulated paths (1,000,000 unless "
                       "--monte-carlo sets another number), separated by commas, or all")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(CLI::IsMember(names));
  command
      ->add_option("--at", arguments->at,
                   "stages for which the table of methods is printed, separated by commas; "
                   "default: the last")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs(methods)
      ->check(CLI::Range(1, kMostStages));
  add_seed_option(*command, arguments->seed,
                  "seed of the simulated paths; default: the scenario's");
  command->add_option("--out", arguments->out, "output folder; default: out/NAME-predict");
  add_force_option(*command, arguments->force);
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->add_flag("--json", arguments->json, "print predict.json instead of the table");
  command->callback([arguments, &exit_code] { exit_code = predict(*arguments); });
}

}  // namespace qsmpc::harness
