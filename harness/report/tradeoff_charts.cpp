#include "harness/report/tradeoff_charts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>

#include <fmt/format.h>

#include "harness/figures/palette.hpp"
#include "harness/report/table_page.hpp"
#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLabelLimit = 18;       // of settings beside a point
constexpr std::size_t kPanelTitleLimit = 40;  // of a scenario, and of a plant
constexpr double kBelowOneDrive = 0.5;        // of the rate of one drive: where the axis begins
constexpr const char* kTradeoffNote =
    "Left and down is better. Whiskers are 99 % intervals: Clopper and Pearson's of the rate, a "
    "bootstrap's of the mean. A variant without an unsafe drive stands at 0, left of the break, "
    "and its whisker ends at the highest rate that is compatible with that. Costs are means over "
    "the drives that reached the target, since those of other drives do not compare: a variant "
    "that reaches it less often may look cheaper.";

std::string panel_title(const TradeoffPanel& panel) {
  std::string title = "Risk against cost: " + printable(panel.scenario, kPanelTitleLimit);
  if (!panel.plant.empty()) title += ", " + printable(panel.plant, kPanelTitleLimit);
  return title;
}

Series series_of_family(const CampaignStatistics& statistics, const TradeoffFamily& family,
                        int colour) {
  Series series{.name = family.name, .colour = colour, .mark = Mark::kJoined};
  for (const TradeoffPoint& point : family.points) {
    const VariantStatistics& variant = statistics.variants[point.variant];
    series.x.push_back(variant.unsafe.rate);
    series.x_lower.push_back(variant.unsafe.interval.lower);
    series.x_upper.push_back(variant.unsafe.interval.upper);
    series.y.push_back(point.cost.mean);
    series.lower.push_back(point.cost.interval.lower);
    series.upper.push_back(point.cost.interval.upper);
    series.labels.push_back(printable(variant.settings, kLabelLimit));
  }
  return series;
}

std::string panel_in_words(const CampaignStatistics& statistics, const TradeoffPanel& panel) {
  std::string words = panel_title(panel) + ".";
  for (const TradeoffFamily& family : panel.families) {
    words += " " + family.name + ":";
    for (const TradeoffPoint& point : family.points) {
      const VariantStatistics& variant = statistics.variants[point.variant];
      words +=
          fmt::format("{} {} {} % unsafe, mean cost {}", &point == family.points.data() ? "" : ";",
                      variant.settings, format_percent(variant.unsafe.rate),
                      std::isfinite(point.cost.mean) ? format_short(point.cost.mean) : "none");
    }
    words += ".";
  }
  return words;
}

/// The power of ten below half of the rate of one unsafe drive: smaller ones cannot be observed.
double least_rate(const CampaignStatistics& statistics, const TradeoffPanel& panel) {
  std::int64_t most = 1;
  for (const TradeoffFamily& family : panel.families) {
    for (const TradeoffPoint& point : family.points) {
      most = std::max(most, statistics.variants[point.variant].done);
    }
  }
  return std::pow(10.0, std::floor(std::log10(kBelowOneDrive / static_cast<double>(most))));
}

/// "w20 74 of 100 (26 timed out)"; empty where all drives reached the target.
std::string arrivals(const VariantStatistics& variant) {
  if (variant.reached.events == variant.done) return {};
  std::string text = fmt::format("{} {} of {}", printable(variant.settings, kLabelLimit),
                                 variant.reached.events, variant.done);
  if (variant.timeout.events > 0) text += fmt::format(" ({} timed out)", variant.timeout.events);
  return text;
}

/// How many drives the means are of; a point of none is not drawn. Empty before the first drive.
std::string panel_note(const CampaignStatistics& statistics, const TradeoffPanel& panel) {
  std::set<std::size_t> seen;  // variants; one may be of several families
  std::int64_t done = 0;
  std::string few;
  for (const TradeoffFamily& family : panel.families) {
    for (const TradeoffPoint& point : family.points) {
      if (!seen.insert(point.variant).second) continue;
      done += statistics.variants[point.variant].done;
      const std::string text = arrivals(statistics.variants[point.variant]);
      if (!text.empty()) few += (few.empty() ? "" : ", ") + text;
    }
  }
  if (done == 0) return {};
  return few.empty() ? "All drives reached the target."
                     : "All drives reached the target, except: " + few + ".";
}

Chart panel_chart(const CampaignStatistics& statistics, const TradeoffPanel& panel) {
  const double least = least_rate(statistics, panel);
  Chart chart{.title = panel_title(panel),
              .note = panel_note(statistics, panel),
              .in_words = panel_in_words(statistics, panel),
              .x_label = "share of unsafe drives (–)",
              .y_label = "mean cost of the drives that reached the target (–)",
              .x_scale = Scale::kLog,
              .least_x = least,
              .x_has_zero = true,
              .x_includes = {least}};
  int colour = 0;
  for (const TradeoffFamily& family : panel.families) {
    chart.series.push_back(series_of_family(statistics, family, colour++ % kPaletteSize));
  }
  return chart;
}

std::vector<std::string> row_of(const VariantStatistics& variant, const TradeoffFamily& family,
                                const TradeoffPoint& point) {
  return {fmt::format("{}: {}", point.variant + 1, escape_html(variant.name)),
          escape_html(family.name),
          fmt::format("{}", variant.done),
          fmt::format("{}", variant.reached.events),
          fmt::format("{}", variant.timeout.events),
          fmt::format("{}", variant.unsafe.events),
          number_html(variant.unsafe.rate) + " " + interval_html(variant.unsafe.interval),
          number_html(point.cost.mean) + " " + interval_html(point.cost.interval)};
}

}  // namespace

std::vector<Chart> tradeoff_charts(const CampaignStatistics& statistics) {
  std::vector<Chart> charts;
  charts.reserve(statistics.tradeoff.size());
  for (const TradeoffPanel& panel : statistics.tradeoff) {
    charts.push_back(panel_chart(statistics, panel));
  }
  return charts;
}

std::string tradeoff_section(const CampaignStatistics& statistics) {
  if (statistics.tradeoff.empty()) return {};
  PageTable table{.label = "Risk against cost, by variant",
                  .heads = {"variant", "family", "drives", "reached", "timeout", "unsafe",
                            "unsafe, share of drives", "cost of those that reached, mean"},
                  .rows = {},
                  .text_columns = {1}};
  std::string charts;
  for (const TradeoffPanel& panel : statistics.tradeoff) {
    charts += chart_figure(panel_chart(statistics, panel));
    for (const TradeoffFamily& family : panel.families) {
      for (const TradeoffPoint& point : family.points) {
        table.rows.push_back(row_of(statistics.variants[point.variant], family, point));
      }
    }
  }
  return section_head("Risk against cost", kTradeoffNote) + "<div class=\"grid\">\n" + charts +
         "</div>\n" + table_html(table);
}

}  // namespace qsmpc::harness
