#include "harness/report/contest_charts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "harness/figures/chart_marks.hpp"
#include "harness/figures/palette.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kDotLabelLimit = 18;  // of a controller's name beside its dot
constexpr std::size_t kCellTitleLimit = 60;
constexpr double kBelowOneOfAll = 0.5;  // the axis begins at this fraction of the rate of one
                                        // unsafe drive

/// A controller's cost, i.e. its place along the vertical axis.
struct CostPlace {
  double mean = 0.0;
  RateInterval interval{};
};

CostPlace relative_place(const Standing& standing) {
  if (standing.reached.events == 0) return {.mean = kNotANumber};
  if (!standing.versus) return {.mean = 1.0, .interval = {.lower = 1.0, .upper = 1.0}};
  return {.mean = standing.versus->cost.ratio, .interval = standing.versus->cost.ratio_interval};
}

CostPlace absolute_place(const Standing& standing) {
  return {.mean = standing.cost.mean, .interval = standing.cost.interval};
}

std::string standings_in_words(const ContestResults& results, const std::string& title,
                               const std::vector<Standing>& standings,
                               CostPlace (*place)(const Standing&)) {
  std::string words = title + ":";
  for (std::size_t n = 0; n < standings.size(); ++n) {
    const double cost = place(standings[n]).mean;
    words +=
        fmt::format("{} {} {} % unsafe, cost {}", n == 0 ? "" : ";",
                    results.contest.controllers[n].name, format_percent(standings[n].unsafe.rate),
                    std::isfinite(cost) ? format_short(cost) : "none");
  }
  return words + ".";
}

/// States which controllers have no dot, and why.
std::string missing_dots(const ContestResults& results, const std::vector<Standing>& standings,
                         CostPlace (*place)(const Standing&)) {
  std::string names;
  for (std::size_t n = 0; n < standings.size(); ++n) {
    if (std::isfinite(place(standings[n]).mean)) continue;
    names += (names.empty() ? "" : ", ") +
             printable(results.contest.controllers[n].name, kDotLabelLimit);
  }
  return names.empty() ? names : "No dot because no drive arrives: " + names + ".";
}

Chart standings_chart(const ContestResults& results, const std::string& title,
                      const std::vector<Standing>& standings, CostPlace (*place)(const Standing&)) {
  std::int64_t most = 1;
  for (const Standing& standing : standings) most = std::max(most, standing.drives);
  Chart chart{.title = title,
              .note = missing_dots(results, standings, place),
              .in_words = standings_in_words(results, title, standings, place),
              .x_label = "share of drives that were unsafe (–)",
              .y_label = "mean cost of arrivals (–)",
              .x_scale = Scale::kLog};
  chart.least_x =
      std::pow(10.0, std::floor(std::log10(kBelowOneOfAll / static_cast<double>(most))));
  chart.x_has_zero = true;
  chart.x_includes = {chart.least_x};
  for (std::size_t n = 0; n < standings.size(); ++n) {
    const EpisodeRate& unsafe = standings[n].unsafe;
    const CostPlace cost = place(standings[n]);
    const std::string name = printable(results.contest.controllers[n].name, kDotLabelLimit);
    chart.series.push_back({.name = name,
                            .colour = static_cast<int>(n) % kPaletteSize,
                            .marker = static_cast<int>(n) % kMarkerCount,
                            .mark = Mark::kJoined,
                            .x = {unsafe.rate},
                            .y = {cost.mean},
                            .lower = {cost.interval.lower},
                            .upper = {cost.interval.upper},
                            .x_lower = {unsafe.interval.lower},
                            .x_upper = {unsafe.interval.upper},
                            .labels = {name}});
    // Controllers without a place are listed in the note.
    if (!std::isfinite(unsafe.rate) || !std::isfinite(cost.mean)) chart.series.pop_back();
  }
  return chart;
}

/// Removes charts without a dot, which would add nothing to their tables.
void leave_out_empty(std::vector<Chart>& charts) {
  std::erase_if(charts, [](const Chart& chart) { return chart.series.empty(); });
}

}  // namespace

Chart overall_chart(const ContestResults& results) {
  Chart chart = standings_chart(results, "Risk against cost, over all maps, plants and noise",
                                results.overall, relative_place);
  chart.y_label =
      "cost, relative to " +
      printable(results.contest.controllers[results.contest.reference].name, kDotLabelLimit) +
      " (–)";
  return chart;
}

std::vector<Chart> cell_charts(const ContestResults& results) {
  std::vector<Chart> charts;
  for (const CellStandings& cell : results.cells) {
    charts.push_back(standings_chart(results, printable(cell.name, kCellTitleLimit), cell.standings,
                                     absolute_place));
  }
  leave_out_empty(charts);
  return charts;
}

std::vector<Chart> contest_charts(const ContestResults& results) {
  std::vector<Chart> charts = cell_charts(results);
  if (results.cells.size() > 1) charts.insert(charts.begin(), overall_chart(results));
  leave_out_empty(charts);
  return charts;
}

}  // namespace qsmpc::harness
