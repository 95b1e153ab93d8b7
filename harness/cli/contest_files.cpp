#include "harness/cli/contest_files.hpp"

#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/contest/contest_results.hpp"
#include "harness/errors.hpp"
#include "harness/figures/pdf_figure.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/report/contest_charts.hpp"
#include "harness/report/contest_page.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kContestPage = "contest.html";
constexpr const char* kContestNumbers = "contest.json";
constexpr const char* kContestTable = "contest.csv";

/// Writes no figures if no drive arrives; earlier ones are then removed.
void write_figures(const std::vector<Chart>& charts, const std::string& title,
                   const std::string& folder) {
  const std::string drawing = folder + "/" + kContestFigure;
  const std::string paper = folder + "/" + kContestPaperFigure;
  if (charts.empty()) {
    for (const std::string& file : {drawing, paper}) {
      std::error_code error;
      std::filesystem::remove(file, error);
      if (error) throw IoError(file + ": cannot be removed: " + error.message());
    }
    return;
  }
  const std::string figure = svg_figure(charts);
  write_file(drawing, figure);
  write_file(paper, pdf_figure(figure, title));
}

}  // namespace

ContestResults write_contest_files(const Contest& contest, const TuningResult& tuning,
                                   const std::string& folder, bool is_timed) {
  (void)write_campaign_results(folder);  // the checksums have already been compared
  const StoreReader drives(folder);
  std::optional<StoreReader> timed;
  if (is_timed) timed.emplace(folder + "/" + kTimingFolder).verify();
  ContestResults results = contest_results(contest, tuning, drives, timed ? &*timed : nullptr);
  write_figures(contest_charts(results), contest.name, folder);
  write_file(folder + "/" + kContestTable, contest_csv(results));
  write_file(folder + "/" + kContestPage, contest_page(results));
  write_file(folder + "/" + kContestNumbers, contest_json(results));
  return results;
}

std::string contest_files_text(const std::string& folder) {
  std::error_code ignored;
  const bool drawn = std::filesystem::exists(folder + "/" + kContestFigure, ignored);
  return fmt::format(
      "\n  page     {0}/{1}\n  numbers  {0}/{2}, {3}\n{4}  drives   {0}/report.html\n"
      "  stores   {0}/{5}, {6}/{5}, {7}/{5}\n",
      folder, kContestPage, kContestNumbers, kContestTable,
      drawn ? fmt::format("  figure   {}/{}, {}\n", folder, kContestFigure, kContestPaperFigure)
            : "",
      kStoreFile, kTuningFolder, kTimingFolder);
}

}  // namespace qsmpc::harness
