#include "harness/cli/contest_files.hpp"

#include <optional>
#include <vector>

#include <fmt/format.h>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/contest/contest_results.hpp"
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

}  // namespace

ContestResults write_contest_files(const Contest& contest, const TuningResult& tuning,
                                   const std::string& folder, bool is_timed) {
  (void)write_campaign_results(folder);  // after the checksums are compared
  const StoreReader drives(folder);
  std::optional<StoreReader> timed;
  if (is_timed) timed.emplace(folder + "/" + kTimingFolder).verify();
  ContestResults results = contest_results(contest, tuning, drives, timed ? &*timed : nullptr);
  const std::string figure = svg_figure(contest_charts(results));
  write_file(folder + "/" + kContestFigure, figure);
  write_file(folder + "/" + kContestPaperFigure, pdf_figure(figure, contest.name));
  write_file(folder + "/" + kContestTable, contest_csv(results));
  write_file(folder + "/" + kContestPage, contest_page(results));
  write_file(folder + "/" + kContestNumbers, contest_json(results));
  return results;
}

std::string contest_files_text(const std::string& folder) {
  return fmt::format(
      "\n  page     {0}/{1}\n  numbers  {0}/{2}, {3}\n  figure   {0}/{4}, {5}\n  drives   "
      "{0}/report.html\n  stores   {0}/{6}, {7}/{6}, {8}/{6}\n",
      folder, kContestPage, kContestNumbers, kContestTable, kContestFigure, kContestPaperFigure,
      kStoreFile, kTuningFolder, kTimingFolder);
}

}  // namespace qsmpc::harness
