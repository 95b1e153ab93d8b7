#include "harness/report/campaign_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "harness/report/campaign_charts.hpp"
#include "harness/report/html.hpp"
#include "harness/report/numbers.hpp"
#include "harness/report/page_frame.hpp"
#include "harness/report/svg_figure.hpp"

namespace qsmpc {
namespace {

constexpr std::size_t kFifth = 1;   // of spread_shares
constexpr std::size_t kMedian = 3;  // the same

std::string number(double value) { return std::isfinite(value) ? format_short(value) : "–"; }

std::string interval(const RateInterval& limits) {
  return fmt::format("<span class=\"soft\">[{}, {}]</span>", number(limits.lower),
                     number(limits.upper));
}

std::string rate(const EpisodeRate& rate) {
  return number(rate.rate) + " " + interval(rate.interval);
}

std::string cells(const std::vector<std::string>& values) {
  std::string html;
  for (const std::string& value : values) html += "<td>" + value + "</td>";
  return html;
}

std::string table(const std::vector<std::string>& heads, const std::string& rows) {
  std::string html = "<div class=\"card scroll\"><table class=\"results\">\n<thead><tr>";
  for (std::size_t n = 0; n < heads.size(); ++n) {
    html += fmt::format("<th{}>{}</th>", n == 0 ? " class=\"text\"" : "", heads[n]);
  }
  return html + "</tr></thead>\n<tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string name_cell(const CampaignStatistics& statistics, std::size_t variant) {
  return fmt::format("<td class=\"text\">{}: {}</td>", variant + 1,
                     escape_html(statistics.variants[variant].name));
}

std::int64_t exceeded_bins(const std::vector<CalibrationBin>& bins) {
  return std::ranges::count_if(bins, &CalibrationBin::exceeded);
}

/// What is to be known before everything else.
std::string verdict(const CampaignStatistics& statistics) {
  std::int64_t periods = 0;
  std::int64_t unsafe = 0;
  double certified = 0.0;
  std::int64_t exceeded = exceeded_bins(statistics.calibration);
  for (const VariantStatistics& variant : statistics.variants) {
    periods += variant.periods;
    unsafe += variant.unsafe_periods;
    certified += variant.certified_periods;
    exceeded += exceeded_bins(variant.calibration);
  }
  return fmt::format(
      "<div class=\"outcome {}\"><span class=\"badge\">{}</span><p>{} of {} periods ended unsafe; "
      "their certificates add up to {}. p = {} against “no certificate is too low”.</p></div>\n",
      exceeded > 0 ? "bad" : "good",
      exceeded > 0 ? "Certificates are exceeded" : "No certificate is refuted", unsafe, periods,
      number(certified), number(statistics.p_value));
}

std::string kicker(const CampaignStatistics& statistics) {
  std::string text =
      fmt::format("{} of {} episodes", statistics.done, statistics.campaign.episodes);
  for (const auto& [outcome, count] : statistics.outcomes) {
    text += fmt::format(", {} {}", escape_html(outcome), count);
  }
  const Shard& shard = statistics.campaign.shard;
  if (shard.count > 1) text += fmt::format(", shard {} of {}", shard.index, shard.count);
  return fmt::format("<p class=\"kicker\">{}, seeds {}</p>\n", text,
                     escape_html(statistics.campaign.seeds));
}

std::string outcomes_table(const CampaignStatistics& statistics) {
  std::string rows;
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    rows += "<tr>" + name_cell(statistics, n) +
            cells({fmt::format("{}", variant.done), rate(variant.reached), rate(variant.unsafe),
                   fmt::format("{}", variant.fault.events), number(variant.cost.mean),
                   number(variant.min_clearance.quantiles[kFifth]),
                   number(variant.time_to_target.quantiles[kMedian])}) +
            "</tr>\n";
  }
  return "<h2>Episodes</h2>\n<p class=\"note\">Shares with their 99 % intervals; the mean cost, "
         "the "
         "clearance that 5 % do not exceed, the median time of those that arrived.</p>\n" +
         table({"variant", "done", "reached", "unsafe", "faults", "cost", "clearance, 5 % (m)",
                "time (s)"},
               rows);
}

std::string certificates_table(const CampaignStatistics& statistics) {
  std::string rows;
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    rows += "<tr>" + name_cell(statistics, n) +
            cells({fmt::format("{}", variant.periods), fmt::format("{}", variant.unsafe_periods),
                   number(variant.unsafe_step_rate()), number(variant.certified_step_rate()),
                   number(variant.p_value), fmt::format("{}", exceeded_bins(variant.calibration)),
                   number(variant.ocp_ms.median), number(variant.ocp_ms.p99)}) +
            "</tr>\n";
  }
  return "<h2>Certificates of the next step, and planning</h2>\n<p class=\"note\">p is small where "
         "more periods end unsafe than certified for them.</p>\n" +
         table({"variant", "periods", "unsafe", "observed", "certified", "p", "bins exceeded",
                "planning, median (ms)", "99 % (ms)"},
               rows);
}

std::string differences_table(const CampaignStatistics& statistics) {
  if (statistics.differences.empty()) return {};
  std::vector<std::string> heads{"variant less baseline"};
  for (const std::string& quantity : paired_quantities()) heads.push_back(quantity);
  std::string rows;
  for (const VariantDifference& difference : statistics.differences) {
    std::vector<std::string> values;
    for (const MeanDifference& mean : difference.quantities) {
      values.push_back(number(mean.mean) + "<br/>" + interval(mean.interval));
    }
    rows += fmt::format("<tr><td class=\"text\">{} less {}</td>{}</tr>\n",
                        difference.pair.variant + 1, difference.pair.baseline + 1, cells(values));
  }
  return "<h2>Differences, seed by seed</h2>\n<p class=\"note\">Means with 99 % bootstrap "
         "intervals.</p>\n" +
         table(heads, rows);
}

std::string figures(const CampaignStatistics& statistics) {
  std::string html = "<h2>Figures</h2>\n<div class=\"grid\">\n";
  for (const CampaignFigure& figure : campaign_figures(statistics)) {
    for (const Chart& chart : figure.charts) html += panel_figure(chart);
  }
  return html + "</div>\n";
}

}  // namespace

std::string campaign_page(const CampaignStatistics& statistics) {
  const std::string name = escape_html(statistics.campaign.name);
  return page_head(statistics.campaign.name) + "<h1>" + name + "</h1>\n" + kicker(statistics) +
         verdict(statistics) + outcomes_table(statistics) + certificates_table(statistics) +
         differences_table(statistics) + figures(statistics) +
         page_foot(statistics.campaign.version);
}

}  // namespace qsmpc
