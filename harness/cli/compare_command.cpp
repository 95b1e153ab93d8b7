#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/artefacts.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/plant_warnings.hpp"
#include "harness/cli/progress.hpp"
#include "harness/cli/result_folder.hpp"
#include "harness/cli/scenario_arguments.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/mismatch/comparison.hpp"
#include "harness/mismatch/comparison_file.hpp"
#include "harness/mismatch/comparison_json.hpp"
#include "harness/mismatch/comparison_table.hpp"
#include "harness/mismatch/measured_error.hpp"
#include "harness/report/comparison_charts.hpp"
#include "harness/report/comparison_page.hpp"
#include "harness/scenario/error_origin.hpp"
#include "harness/scenario/model_error_reader.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/scenario_warnings.hpp"
#include "harness/text/printable.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kCompareHelp =
    "Measures how far plants deviate from the planner's model, in closed loop, in every period\n"
    "and along a plan, and how this affects the certificates; writes comparison.json,\n"
    "comparison.h5, scenario.yaml, figures and a page (report.html).";
constexpr const char* kCompareExample =
    "Example: qsmpc compare dubins_corridor --plant analytic --plant mujoco_car --episodes 50\n"
    "A plant is \"analytic\", \"mujoco\" (the scenario's own vehicle), the name of a shipped one,\n"
    "or the path of an MJCF file. Without --plant: analytic, and the scenario's own if it is\n"
    "another.";
constexpr int kMostEpisodes = 100'000;
constexpr std::int64_t kMostPaths = 100'000;  // all their states are kept

struct CompareArguments {
  std::string scenario;
  std::vector<std::string> overrides;
  std::optional<std::uint64_t> seed;
  std::string out;
  bool force = false;
  bool quiet = false;
  bool json = false;
  std::string error_file;
  ComparisonOptions options;
};

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::vector<TextFile> report_files(const Comparison& comparison, const std::string& folder) {
  std::vector<TextFile> files;
  for (const ComparisonFigure& figure : comparison_figures(comparison)) {
    files.push_back({.path = folder + "/" + figure.file, .text = svg_figure(figure.charts)});
  }
  files.push_back({.path = folder + "/" + kPageFile, .text = comparison_page(comparison)});
  return files;
}

/// The file that the scenario key `model_error` may name.
TextFile error_file(const Comparison& comparison, const std::string& path) {
  const std::string origin = fmt::format(
      "qsmpc compare {}, plant {}, {} episodes, {} paths, seed {}: each norm an upper limit at "
      "{:.0f} %",
      printable(comparison.scenario.name), printable(comparison.error_plant),
      comparison.plants.front().episodes.size(), comparison.paths, comparison.scenario.seed,
      100.0 * (1.0 - kErrorTail));
  return {.path = path,
          .text = model_error_yaml(
              {.error = *comparison.measured_error,
               .origin = error_origin_of(with_plant(comparison.scenario, comparison.error_plant))},
              comparison.scenario.model.system, origin)};
}

/// Returns nothing if interrupted.
std::optional<Comparison> comparison_of(const Scenario& scenario,
                                        const ComparisonOptions& options) {
  try {
    return compare_plants(scenario, options);
  } catch (const Interrupted&) {
    return std::nullopt;
  }
}

std::string files_table(const std::string& folder, const std::vector<TextFile>& more) {
  std::string text = fmt::format("  numbers  {}/{}\n  data     {}/{}\n", folder,
                                 kComparisonNumbersFile, folder, kComparisonFile);
  for (const TextFile& file : more) text += fmt::format("  file     {}\n", file.path);
  return text;
}

int compare(CompareArguments& arguments) {
  Scenario scenario = load_scenario(arguments.scenario, arguments.overrides);
  scenario.seed = arguments.seed.value_or(scenario.seed);
  refuse_motion(scenario, arguments.scenario, arguments.overrides, "compare");
  Scenario warned = scenario;
  warned.error_origin.reset();  // whether the error holds for these plants is being measured
  print_warnings(scenario_warnings(warned));
  refuse_beyond_memory(
      scenario, arguments.scenario, arguments.overrides,
      std::min(usable_threads(arguments.options.threads), arguments.options.episodes));
  const std::string folder = arguments.out.empty()
                                 ? default_folder(scenario.name, "compare", arguments.overrides)
                                 : arguments.out;
  settle_points(scenario, arguments.quiet);
  refuse_other_result(folder, scenario, arguments.force);

  Progress progress("comparing", arguments.quiet);
  ComparisonOptions& options = arguments.options;
  options.should_stop = [] { return interrupts() > 0; };
  options.on_progress = [&](std::int64_t done, std::int64_t total, const std::string& what) {
    progress.update(static_cast<int>(done), static_cast<int>(total), what);
  };
  if (!arguments.error_file.empty() && options.error_plant.empty()) {
    options.error_plant =
        options.plants.empty() ? default_plants(scenario).back() : options.plants.back();
  }
  options.on_plants_ready = [&] {
    tell_plant_warnings(scenario,
                        options.plants.empty() ? default_plants(scenario) : options.plants);
    make_output_folder(folder);
    if (!arguments.error_file.empty()) make_output_folder(folder_of(arguments.error_file));
  };
  const std::optional<Comparison> comparison = comparison_of(scenario, options);
  if (!comparison) {
    std::cerr << "qsmpc: interrupted; nothing was written\n";
    return kInterruptedExit;
  }
  std::vector<TextFile> more = report_files(*comparison, folder);
  if (!arguments.error_file.empty()) more.push_back(error_file(*comparison, arguments.error_file));
  write_comparison(*comparison, more, folder);
  print_result(arguments.json ? comparison_json(*comparison)
                              : comparison_table(*comparison) + files_table(folder, more));
  return kDone;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("compare", kCompareHelp);
  command->footer(kCompareExample);
  const auto arguments = std::make_shared<CompareArguments>();
  ComparisonOptions& options = arguments->options;
  add_scenario_argument(*command, arguments->scenario);
  command->add_option("--plant", options.plants, "NAME: a plant to compare; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--episodes", options.episodes, "episodes per plant; default: 50")
      ->check(CLI::Range(1, kMostEpisodes));
  command->add_option("--paths", options.paths, "paths per plant under one plan; default: 1000")
      ->check(CLI::Range(std::int64_t{1}, kMostPaths));
  command
      ->add_option("--threads", options.threads,
                   "number of threads; default: all cores; does not affect results")
      ->check(CLI::Range(1, kMostAtOnce));
  CLI::Option* error_file = command->add_option(
      "--write-model-error", arguments->error_file,
      "FILE (YAML): the measured model error, for the scenario's key model_error");
  command
      ->add_option("--model-error-plant", options.error_plant,
                   "NAME: the plant whose model error is written; default: the one named last")
      ->needs(error_file);
  add_set_option(*command, arguments->overrides);
  add_seed_option(*command, arguments->seed,
                  "seed of the first episode and of the paths; default: the scenario's");
  command->add_option("--out", arguments->out, "output folder; default: out/NAME-compare");
  add_force_option(*command, arguments->force);
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->add_flag("--json", arguments->json, "print comparison.json instead of the table");
  command->callback([arguments, &exit_code] { exit_code = compare(*arguments); });
}

}  // namespace qsmpc::harness
