#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/artefacts.hpp"
#include "harness/cli/campaign_episodes.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/mismatch/comparison_file.hpp"
#include "harness/report/comparison_page.hpp"
#include "harness/report/figure_files.hpp"
#include "harness/trace/trace_file.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kMostWorst = 1000;

struct ReportArguments {
  std::string folder;
  bool figures = false;
  FigureStyle style{.titles = false};  ///< of the figures
  std::size_t worst = 0;               ///< number of episodes to make pages and videos of; 0: none
  bool quiet = false;
};

bool has(const std::string& folder, const char* file) {
  std::error_code ignored;
  return std::filesystem::exists(folder + "/" + file, ignored);
}

int report(const ReportArguments& arguments) {
  const std::string& folder = arguments.folder;
  const bool is_campaign = has(folder, kStoreFile);
  if (arguments.worst > 0 && !is_campaign) {
    throw InputError({.key = "--worst",
                      .found = folder + " without " + kStoreFile,
                      .expected = "the folder of a campaign"});
  }
  bool finished = true;
  std::vector<FigureFile> figures;
  if (is_campaign) {
    if (arguments.worst > 0) {
      finished = make_worst_episodes(folder, arguments.worst, arguments.quiet);
    }
    figures = figures_of(write_campaign_results(folder, std::max(arguments.worst, kWorstListed)));
  } else if (has(folder, kComparisonFile)) {
    const Comparison comparison = read_comparison(folder);
    figures = figures_of(comparison);
    write_file(folder + "/" + kPageFile, comparison_page(comparison));
  } else {
    const Trace trace = read_folder(folder);
    const EpisodeView view(trace);
    write_page(view, folder, has(folder, kVideoFile));
    if (arguments.figures) figures = episode_figures(view);
  }
  std::string paths = folder + "/" + kPageFile + "\n";
  if (arguments.figures) {
    for (const std::string& path : write_figures(figures, folder, arguments.style))
      paths += path + "\n";
  }
  print_result(paths);
  return finished ? kDone : kInterruptedExit;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report",
                                         "Writes a self-contained HTML page from an episode's "
                                         "trace, a comparison's data or a campaign's\nstore, with "
                                         "its numbers, tables and figures.");
  command->footer(
      "Example: qsmpc report out/dubins_obstacles-0 --figures\n"
      "For a campaign, with pages and videos: qsmpc report out/policies --worst 5");
  const auto arguments = std::make_shared<ReportArguments>();
  command
      ->add_option("folder", arguments->folder, "folder of an episode, a comparison or a campaign")
      ->required();
  CLI::Option* figures =
      command->add_flag("--figures", arguments->figures,
                        "also write the charts as SVG and PDF files to FOLDER/figures");
  command
      ->add_option("--columns", arguments->style.columns,
                   "with --figures: width in columns of a paper, 1 or 2 (3.5 or 7.16 inches)")
      ->needs(figures)
      ->check(CLI::Range(1, 2));
  command->add_flag("--titles", arguments->style.titles, "with --figures: include titles and notes")
      ->needs(figures);
  command
      ->add_option("--worst", arguments->worst,
                   "N: also make page and video of a campaign's N worst episodes, driven again if "
                   "their trace was not kept")
      ->check(CLI::Range(std::size_t{1}, kMostWorst));
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->callback([arguments, &exit_code] { exit_code = report(*arguments); });
}

}  // namespace qsmpc::harness
