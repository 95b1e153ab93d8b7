#include "harness/report/rare_section.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "harness/campaign/rare/rare_scenarios.hpp"
#include "harness/figures/palette.hpp"
#include "harness/report/table_page.hpp"
#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kRareTitleLimit = 44;   // of a variant's name in a title
constexpr std::size_t kMostRareCommands = 5;  // per variant
constexpr double kMostRareGap = 0.3;          // of a decade, below the smallest estimate
constexpr const char* kRareNote =
    "The probability that a drive is unsafe at some control instant, estimated by splitting: "
    "drives that came near the unsafe set are driven again from there, with different noise. Each "
    "run gives an unbiased estimate. Limits are 99 % limits, from the spread of the runs. Worth: "
    "the number of plain periods for which the share of unsafe drives is as precise; gain: the "
    "ratio of that number to the periods driven. Certified: the mean of the sum of a drive's "
    "next-step "
    "certificates, estimated from the same drives, which bounds the probability where they are "
    "bounds.";

bool looks_for_rare(const CampaignStatistics& statistics) {
  return std::ranges::any_of(statistics.variants,
                             [](const auto& variant) { return variant.rare.has_value(); });
}

/// The smallest value that the axis has to show.
double least_rare(const RareStatistics& rare) {
  double least = rare.probability > 0.0 ? rare.probability : rare.interval.upper;
  for (const RareEstimate& run : rare.runs) {
    if (run.probability > 0.0) least = std::min(least, run.probability);
  }
  if (rare.interval.lower > 0.0) least = std::min(least, rare.interval.lower);
  return std::pow(10.0, std::floor(std::log10(least) - kMostRareGap));
}

Chart rare_chart(const VariantStatistics& variant, const RareStatistics& rare) {
  Chart chart{.title = printable(variant.name, kRareTitleLimit),
              .in_words = fmt::format(
                  "{}: a drive is unsafe with a probability of {}, {} to {}; "
                  "certified {}.",
                  variant.name, format_short(rare.probability), format_short(rare.interval.lower),
                  format_short(rare.interval.upper),
                  std::isfinite(rare.certified) ? format_short(rare.certified) : "nothing"),
              .x_label = "run (–)",
              .y_label = "probability of an unsafe drive (–)",
              .y_scale = Scale::kLog,
              .least_shown = least_rare(rare)};
  Series estimates{.name = "one run", .colour = kBlue, .mark = Mark::kPoints};
  for (std::size_t n = 0; n < rare.runs.size(); ++n) {
    estimates.x.push_back(static_cast<double>(n + 1));
    estimates.y.push_back(rare.runs[n].probability);
    if (rare.runs[n].probability == 0.0) chart.y_has_zero = true;
  }
  chart.x_includes = {0.0, static_cast<double>(rare.runs.size() + 1)};
  // The limits follow after the runs.
  Series mean{.name = "mean, 99 % limits", .colour = kVermilion, .mark = Mark::kPoints};
  mean.x = {static_cast<double>(rare.runs.size() + 1)};
  mean.y = {rare.probability};
  mean.lower = {rare.interval.lower};
  mean.upper = {rare.interval.upper};
  chart.series = {std::move(estimates), std::move(mean)};
  chart.rules.push_back({.name = variant.no_bound.empty() ? "certified" : "certified, not a bound",
                         .value = rare.certified});
  return chart;
}

PageVerdict rare_verdict(const VariantStatistics& variant, const RareStatistics& rare) {
  const bool holds = variant.no_bound.empty();
  const bool exceeded = holds && rare.exceeds_certified();
  const bool compared = holds && std::isfinite(rare.certified);
  PageVerdict verdict{.mood = exceeded   ? PageMood::kBad
                              : compared ? PageMood::kGood
                                         : PageMood::kOpen,
                      .title = fmt::format("{}: a drive is unsafe with a probability of {}",
                                           variant.name, format_short(rare.probability)),
                      .sentences = {}};
  verdict.sentences.push_back(fmt::format(
      "Between {} and {} with 99 % confidence, from {} runs of {} drives, {} periods in "
      "all.",
      format_short(rare.interval.lower), format_short(rare.interval.upper), rare.runs.size(),
      rare.drives, rare.periods));
  if (std::isfinite(rare.worth_periods)) {
    verdict.sentences.push_back(
        fmt::format("Plain drives would need {} periods to be as precise, {} times as many.",
                    format_short(rare.worth_periods), format_short(rare.gain())));
  }
  if (std::isfinite(rare.certified)) {
    verdict.sentences.push_back(fmt::format("Certified for a drive: {}, {}.",
                                            format_short(rare.certified),
                                            exceeded ? "which is exceeded"
                                            : holds  ? "which is not refuted"
                                                     : "which is not a bound here"));
  }
  return verdict;
}

std::string rare_rows_html(const CampaignStatistics& statistics) {
  PageTable table{.label = "Probability of an unsafe drive, by variant",
                  .heads = {"variant", "runs", "unsafe drive", "collision", "left bounds",
                            "certified per drive", "periods driven", "worth", "gain", "runs at 0"},
                  .rows = {}};
  for (const VariantStatistics& variant : statistics.variants) {
    if (!variant.rare) continue;
    const RareStatistics& rare = *variant.rare;
    table.rows.push_back(
        {fmt::format("{}: {}", variant.id, escape_html(variant.name)),
         fmt::format("{}", rare.runs.size()),
         number_html(rare.probability) + " " + interval_html(rare.interval),
         number_html(rare.collision), number_html(rare.left_bounds),
         number_html(rare.certified) + " " + interval_html(rare.certified_interval) +
             (variant.no_bound.empty() ? "" : " <strong>no bound</strong>"),
         fmt::format("{}", rare.periods), number_html(rare.worth_periods), number_html(rare.gain()),
         fmt::format("{}", rare.extinct + rare.below_floor)});
  }
  return table_html(table);
}

/// Commands that replay the unsafe drives found, one per run.
std::string rare_commands(const CampaignStatistics& statistics) {
  std::string items;
  for (const VariantStatistics& variant : statistics.variants) {
    if (!variant.rare) continue;
    std::size_t told = 0;
    for (const RareEstimate& run : variant.rare->runs) {
      if (run.found.empty() || told == kMostRareCommands) continue;
      ++told;
      const RareDrive& drive = run.found.front();
      items += fmt::format("<li><code>qsmpc run {}</code>: {}, {} after {} periods</li>\n",
                           escape_html(rare_scenario_file(variant.id, run.seed, 1)),
                           escape_html(variant.name), escape_html(drive.outcome), drive.periods);
    }
  }
  if (items.empty()) return {};
  return "<p class=\"note\">Some of the unsafe drives found. Run the commands in the folder of "
         "this page to drive them again, with video; its subfolder <code>rare</code> has "
         "more.</p>\n"
         "<ul>\n" +
         items + "</ul>\n";
}

}  // namespace

std::vector<Chart> rare_charts(const CampaignStatistics& statistics) {
  std::vector<Chart> charts;
  for (const VariantStatistics& variant : statistics.variants) {
    if (variant.rare) charts.push_back(rare_chart(variant, *variant.rare));
  }
  return charts;
}

std::string rare_section(const CampaignStatistics& statistics) {
  if (!looks_for_rare(statistics)) return {};
  std::string html = section_head("Rare outcomes", kRareNote);
  for (const VariantStatistics& variant : statistics.variants) {
    if (variant.rare) html += verdict_html(rare_verdict(variant, *variant.rare));
  }
  html += rare_rows_html(statistics);
  const std::vector<Chart> charts = rare_charts(statistics);
  const std::string commands = rare_commands(statistics);
  if (charts.size() == 1 && !commands.empty()) {
    return html + "<div class=\"grid beside\">\n" + chart_figure(charts.front()) +
           "<div class=\"card\">\n" + commands + "</div>\n</div>\n";
  }
  html += "<div class=\"grid\">\n";
  for (const Chart& chart : charts) html += chart_figure(chart);
  return html + "</div>\n" + commands;
}

}  // namespace qsmpc::harness
