#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/progress.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/reproduction/experiment.hpp"
#include "harness/reproduction/results_page.hpp"
#include "harness/reproduction/results_table.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kReproduceHelp =
    "Repeats the reference thesis's experiments and compares each number with the published one;\n"
    "writes results.json, results.md, results.html and the figures, updated after each experiment.";
constexpr int kMostSeeds = 100'000;

struct ReproduceArguments {
  std::vector<std::string> names;
  std::string out = "out/reproduce";
  bool quiet = false;
  bool json = false;
  LaboratoryOptions options{};
};

std::string example() {
  std::string text =
      "Example: qsmpc reproduce table-5-2 figure-4-1 --seeds 20\n"
      "Without NAME, or with \"all\": all of them (takes some minutes). The experiments:\n";
  for (const ExperimentEntry& entry : experiments()) {
    text += fmt::format("  {:<12} {}\n", entry.name, entry.title);
  }
  return text;
}

/// Writes all files for the results so far; the numbers last.
void write_results(const Reproduction& reproduction, const std::string& folder) {
  for (const ResultFigure& figure : reproduction.experiments.back().figures) {
    write_file(folder + "/" + figure.file, svg_figure(figure.panels));
  }
  write_file(folder + "/results.md", results_markdown(reproduction, "."));
  write_file(folder + "/results.html", results_page(reproduction));
  write_file(folder + "/results.json", results_json(reproduction));
}

int reproduce_command(ReproduceArguments& arguments) {
  const std::vector<std::string> chosen = experiments_named(arguments.names);
  const std::string& folder = arguments.out;
  make_output_folder(folder);
  Progress progress("reproducing", arguments.quiet);
  std::size_t done = 0;
  arguments.options.should_stop = [] { return interrupts() > 0; };
  arguments.options.on_work = [&](const std::string& what) {
    progress.update(static_cast<int>(done), static_cast<int>(chosen.size()),
                    fmt::format("{}, {}", chosen[std::min(done, chosen.size() - 1)], what));
  };
  Laboratory laboratory(arguments.options);
  const Reproduction reproduction = reproduce(chosen, laboratory, [&](const Reproduction& so_far) {
    done = so_far.experiments.size();
    write_results(so_far, folder);
    progress.update(static_cast<int>(done), static_cast<int>(chosen.size()));
  });
  if (!reproduction.experiments.empty()) {
    print_result(arguments.json ? results_json(reproduction)
                                : results_table(reproduction) +
                                      fmt::format("\n  page     {0}/results.html\n  numbers  "
                                                  "{0}/results.json\n",
                                                  folder));
  }
  if (!reproduction.complete) {
    std::cerr << fmt::format("qsmpc: interrupted; {} of {} experiments are finished and kept\n",
                             reproduction.experiments.size(), chosen.size());
    return kInterruptedExit;
  }
  return kDone;
}

}  // namespace

void add_reproduce_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("reproduce", kReproduceHelp);
  command->footer(example());
  const auto arguments = std::make_shared<ReproduceArguments>();
  LaboratoryOptions& options = arguments->options;
  command->add_option("name", arguments->names, "experiments, see below; default: all");
  command
      ->add_option("--seeds", options.seeds,
                   fmt::format("drives of each kind; default: {}", options.seeds))
      ->check(CLI::Range(1, kMostSeeds));
  command
      ->add_option("--arrival-seeds", options.arrival_seeds,
                   fmt::format("drives of each kind on its model in \"plants\", which only counts "
                               "the share that arrives; default: {}",
                               options.arrival_seeds))
      ->check(CLI::Range(1, kMostSeeds));
  command
      ->add_option("--threads", options.threads,
                   "number of threads; default: all cores; affects only timings")
      ->check(CLI::Range(1, kMostAtOnce));
  command->add_option("--out", arguments->out, "output folder; default: out/reproduce");
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->add_flag("--json", arguments->json, "print results.json instead of the table");
  command->callback([arguments, &exit_code] { exit_code = reproduce_command(*arguments); });
}

}  // namespace qsmpc::harness
