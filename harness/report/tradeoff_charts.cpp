#include "harness/report/tradeoff_charts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>

#include <fmt/format.h>

#include "harness/figures/palette.hpp"
#include "harness/report/campaign_drives.hpp"
#include "harness/report/table_page.hpp"
#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLabelLimit = 18;       // of the settings beside a point
constexpr std::size_t kPanelTitleLimit = 40;  // of a scenario's name, and of a plant's
constexpr double kBelowOneDrive = 0.5;        // the axis begins at this fraction of the rate of one
                                              // drive
constexpr const char* kTradeoffNote =
    "Left and down is better. The left chart shows the observed risk; the one beside it shows the "
    "certified risk, which distinguishes variants whose drives were never unsafe: the mean over "
    "drives of the sum of next-step certificates. For the model it bounds the share of unsafe "
    "drives, up to chance; for another plant only with a model error. Whiskers are 99 % intervals, "
    "those of means by bootstrap. A variant without an unsafe drive stands at 0, left of the "
    "break, and its whisker ends at the highest rate that is compatible with that. Costs are means "
    "over the drives that reached the target, because those of other drives are not comparable: a "
    "variant that reaches it less often may look cheaper.";

/// Which value represents the risk of a variant.
enum class RiskOf { kObserved, kCertified };

std::string panel_title(const TradeoffPanel& panel, RiskOf risk) {
  std::string title =
      risk == RiskOf::kObserved ? "Risk against cost: " : "Certified risk against cost: ";
  title += printable(panel.scenario, kPanelTitleLimit);
  if (!panel.plant.empty()) title += ", " + printable(panel.plant, kPanelTitleLimit);
  return title;
}

Series series_of_family(const CampaignStatistics& statistics, const TradeoffFamily& family,
                        RiskOf risk, int colour) {
  Series series{.name = family.name, .colour = colour, .mark = Mark::kJoined};
  for (const TradeoffPoint& point : family.points) {
    const VariantStatistics& variant = statistics.variants[point.variant];
    const bool observed = risk == RiskOf::kObserved;
    const RateInterval& across = observed ? variant.unsafe.interval : point.certified.interval;
    series.x.push_back(observed ? variant.unsafe.rate : point.certified.mean);
    series.x_lower.push_back(across.lower);
    series.x_upper.push_back(across.upper);
    series.y.push_back(point.cost.mean);
    series.lower.push_back(point.cost.interval.lower);
    series.upper.push_back(point.cost.interval.upper);
    series.labels.push_back(printable(variant.settings, kLabelLimit));
  }
  return series;
}

std::string panel_in_words(const CampaignStatistics& statistics, const TradeoffPanel& panel,
                           RiskOf risk) {
  std::string words = panel_title(panel, risk) + ".";
  for (const TradeoffFamily& family : panel.families) {
    words += " " + family.name + ":";
    for (const TradeoffPoint& point : family.points) {
      const VariantStatistics& variant = statistics.variants[point.variant];
      words += fmt::format(
          "{} {} {}, mean cost {}", &point == family.points.data() ? "" : ";", variant.settings,
          risk == RiskOf::kObserved ? format_percent(variant.unsafe.rate) + " % unsafe"
                                    : "certified " + format_short(point.certified.mean),
          std::isfinite(point.cost.mean) ? format_short(point.cost.mean) : "none");
    }
    words += ".";
  }
  return words;
}

/// The power of ten below half of the rate of one unsafe drive; smaller rates cannot be observed.
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

/// States how many drives the means are over; a point without drives is not drawn. Empty before the
/// first drive.
std::string panel_note(const CampaignStatistics& statistics, const TradeoffPanel& panel) {
  std::set<std::size_t> seen;  // variants; one may belong to several families
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

/// States which of the panel's points have certificates that are not bounds; empty if all are
/// bounds.
std::string no_bound_note(const CampaignStatistics& statistics, const TradeoffPanel& panel) {
  std::set<std::size_t> seen;
  std::string names;
  bool all = true;
  for (const TradeoffFamily& family : panel.families) {
    for (const TradeoffPoint& point : family.points) {
      const VariantStatistics& variant = statistics.variants[point.variant];
      all = all && !variant.no_bound.empty();
      if (variant.no_bound.empty() || !seen.insert(point.variant).second) continue;
      names += (names.empty() ? "" : ", ") + printable(variant.settings, kLabelLimit);
    }
  }
  if (names.empty()) return {};
  return all ? "NO BOUND for any variant." : "NO BOUND: " + names + ".";
}

Chart panel_chart(const CampaignStatistics& statistics, const TradeoffPanel& panel, RiskOf risk) {
  Chart chart{.title = panel_title(panel, risk),
              .note = panel_note(statistics, panel),
              .in_words = panel_in_words(statistics, panel, risk),
              .x_label = "mean certified risk of a drive (–)",
              .y_label = "mean cost of drives that reached (–)",
              .x_scale = Scale::kLog};
  if (risk == RiskOf::kObserved) {
    chart.x_label = "share of unsafe drives (–)";
    chart.least_x = least_rate(statistics, panel);
    chart.x_has_zero = true;
    chart.x_includes = {chart.least_x};
  } else if (const std::string no_bound = no_bound_note(statistics, panel); !no_bound.empty()) {
    chart.note += (chart.note.empty() ? "" : " ") + no_bound;
    chart.in_words += " " + no_bound;
    chart.x_label = "mean certified risk of a drive, no bound (–)";
  }
  int colour = 0;
  for (const TradeoffFamily& family : panel.families) {
    chart.series.push_back(series_of_family(statistics, family, risk, colour++ % kPaletteSize));
  }
  return chart;
}

std::vector<std::string> row_of(const VariantStatistics& variant, const TradeoffFamily& family,
                                const TradeoffPoint& point) {
  return {fmt::format("{}: {}", variant.id, escape_html(variant.name)),
          escape_html(family.name),
          fmt::format("{}", variant.done),
          fmt::format("{}", variant.reached.events),
          fmt::format("{}", variant.timeout.events),
          fmt::format("{}", variant.unsafe.events),
          number_html(variant.unsafe.rate) + " " + interval_html(variant.unsafe.interval),
          number_html(point.certified.mean) + " " + interval_html(point.certified.interval) +
              (variant.no_bound.empty() ? "" : " <strong>no bound</strong>"),
          number_html(point.cost.mean) + " " + interval_html(point.cost.interval)};
}

}  // namespace

std::vector<Chart> tradeoff_charts(const CampaignStatistics& statistics) {
  std::vector<Chart> charts;
  charts.reserve(2 * statistics.tradeoff.size());
  for (const TradeoffPanel& panel : statistics.tradeoff) {
    charts.push_back(panel_chart(statistics, panel, RiskOf::kObserved));
    charts.push_back(panel_chart(statistics, panel, RiskOf::kCertified));
  }
  return charts;
}

std::string tradeoff_section(const CampaignStatistics& statistics) {
  if (statistics.tradeoff.empty()) return {};
  PageTable table{
      .label = "Risk against cost, by variant",
      .heads = {"variant", "family", "drives", "reached", "timeout", "unsafe",
                "unsafe, share of drives", "certified per drive, mean", "cost of arrivals, mean"},
      .rows = {},
      .text_columns = {1}};
  std::string charts;
  for (const Chart& chart : tradeoff_charts(statistics)) charts += chart_figure(chart);
  for (const TradeoffPanel& panel : statistics.tradeoff) {
    for (const TradeoffFamily& family : panel.families) {
      for (const TradeoffPoint& point : family.points) {
        table.rows.push_back(row_of(statistics.variants[point.variant], family, point));
      }
    }
  }
  return section_head("Risk against cost", kTradeoffNote + no_bound_words(statistics)) +
         "<div class=\"grid\">\n" + charts + "</div>\n" + table_html(table);
}

}  // namespace qsmpc::harness
