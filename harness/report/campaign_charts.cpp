#include "harness/report/campaign_charts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/palette.hpp"
#include "harness/report/campaign_drives.hpp"
#include "harness/report/rare_section.hpp"
#include "harness/report/tradeoff_charts.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kLeastCertified = 1e-13;  // left end of the axis: the bin [0, 1e-12) is there
constexpr std::size_t kMostPanels = 16;    // most variants in reliability.svg
constexpr std::size_t kMostPairs = 9;      // most pairs with room below an axis
constexpr std::size_t kMostListed = 20;    // most variants in a note
constexpr std::size_t kNameLimit = 90;     // of a variant's name in a note
constexpr std::size_t kTitleLimit = 44;    // of a variant's name in a title
constexpr double kBeside = 0.12;           // distance between points of one variant
constexpr double kRoom = 0.5;              // margin left and right of the outer variants

constexpr const char* kListedBefore = "Numbers as in the first chart.";
constexpr const char* kRateLabel = "share of periods that ended unsafe (–)";

/// Adds a point with its interval for each bin. A bin without events is drawn at 0, in the part of
/// the axis that is never shaded: nothing went wrong there, however few periods it has. Exceeded
/// bins stand out.
void add_bins(const std::string& name, int colour, const std::vector<CalibrationBin>& bins,
              Chart& chart) {
  Series seen{.name = name, .colour = colour, .mark = Mark::kPoints};
  Series unseen{.name = name + ": none unsafe", .colour = colour, .mark = Mark::kPoints};
  Series exceeded{.name = name + ": exceeded", .colour = kVermilion, .mark = Mark::kPoints};
  for (const CalibrationBin& bin : bins) {
    if (bin.periods == 0) continue;
    if (bin.unsafe == 0) {
      unseen.x.push_back(bin.mean_certified);
      unseen.y.push_back(0.0);
      unseen.lower.push_back(0.0);
      unseen.upper.push_back(bin.interval.upper);
      continue;
    }
    Series& series = bin.exceeded ? exceeded : seen;
    series.x.push_back(bin.mean_certified);
    series.y.push_back(bin.rate);
    series.lower.push_back(bin.interval.lower);
    series.upper.push_back(bin.interval.upper);
  }
  for (Series* series : {&unseen, &seen, &exceeded}) {
    if (!series->x.empty()) chart.series.push_back(std::move(*series));
  }
}

/// Bins of the published value, which is not a bound, so that nothing can exceed it.
std::vector<CalibrationBin> not_bounds(std::vector<CalibrationBin> bins) {
  for (CalibrationBin& bin : bins) bin.exceeded = false;
  return bins;
}

/// The decade below everything that is drawn except for the lower ends of intervals.
double foot_of(const Chart& chart) {
  double least = 0.1;
  for (const Series& series : chart.series) {
    for (const double y : series.y) {
      if (y > 0.0) least = std::min(least, y);
    }
    for (const double upper : series.upper) least = std::min(least, upper);
  }
  return std::pow(10.0, std::floor(std::log10(least) - 0.5));
}

/// The lower end of the axis of certified values, common to all charts of a campaign.
double least_certified(const CampaignStatistics& statistics) {
  double least = 0.1;
  for (const auto* bins : {&statistics.calibration, &statistics.published}) {
    for (const CalibrationBin& bin : *bins) {
      if (bin.periods > 0) least = std::min(least, bin.mean_certified);
    }
  }
  return least > kLeastCertified ? std::pow(10.0, std::floor(std::log10(least))) : kLeastCertified;
}

/// Adds the diagonal from the foot of the chart. Above it, more happened than was certified.
void add_diagonal(Chart& chart) {
  const double foot = std::max(chart.least_shown, chart.least_x);
  const double left = chart.least_x;
  chart.areas.push_back(
      {.name = "more than certified", .x = {left, foot, 1.0, left}, .y = {foot, foot, 1.0, 1.0}});
  chart.series.push_back({.name = "as certified",
                          .colour = kPurple,
                          .dashed = true,
                          .x = {foot, 1.0},
                          .y = {foot, 1.0}});
}

std::string exceeded_text(const std::vector<CalibrationBin>& bins) {
  const auto filled = std::ranges::count_if(bins, [](const auto& bin) { return bin.periods > 0; });
  const auto exceeded = std::ranges::count_if(bins, [](const auto& bin) { return bin.exceeded; });
  return fmt::format("Certificates exceeded: in {} of {} bins", exceeded, filled);
}

struct Reliability {
  std::string title;
  const std::vector<CalibrationBin>& certified;
  const std::vector<CalibrationBin>& published;
  std::string no_bound{};   ///< why, and in which variants, certificates are not bounds; empty: all
                            ///< are
  bool none_holds = false;  ///< none of them is a bound, so none can be exceeded
};

Chart reliability_chart(const Reliability& shown, double least) {
  Chart chart{
      .title = shown.title,
      .note = fmt::format(
          "Periods grouped by certified probability, in half-decade bins; 99 % intervals as if "
          "periods were independent; at 0, no period ended unsafe. Only a point whose whole "
          "interval is shaded contradicts its value. {}.{}",
          shown.none_holds ? "Certificates are not bounds here" : exceeded_text(shown.certified),
          shown.no_bound),
      .x_label = "certified probability, mean of the bin (–)",
      .y_label = kRateLabel,
      .x_scale = Scale::kLog,
      .y_scale = Scale::kLog,
      .least_x = least,
      .y_has_zero = true,
      .x_includes = {least, 1.0},
      .y_includes = {1.0}};
  add_bins("published value, not a bound", kOrange, not_bounds(shown.published), chart);
  if (shown.none_holds) {
    add_bins("certificate, not a bound", kBlue, not_bounds(shown.certified), chart);
  } else {
    add_bins("certificate", kBlue, shown.certified, chart);
  }
  chart.least_shown = foot_of(chart);
  chart.y_includes.push_back(chart.least_shown);
  if (has_points(chart)) add_diagonal(chart);
  return chart;
}

Chart period_chart(const CampaignStatistics& statistics) {
  const double least = least_certified(statistics);
  Chart chart{.title = "Periods by certified probability",
              .note = "Of all variants; the bin below 10⁻¹² is at the left end.",
              .x_label = "certified probability, mean of the bin (–)",
              .y_label = "periods in the bin",
              .x_scale = Scale::kLog,
              .y_scale = Scale::kLog,
              .least_x = least,
              .least_shown = 1.0,
              .x_includes = {least, 1.0}};
  for (const auto& [name, colour, bins] :
       {std::tuple{"published value, not a bound", kOrange, &statistics.published},
        std::tuple{"certificate", kBlue, &statistics.calibration}}) {
    Series series{.name = name, .colour = colour, .mark = Mark::kPoints};
    for (const CalibrationBin& bin : *bins) {
      if (bin.periods == 0) continue;
      series.x.push_back(bin.mean_certified);
      series.y.push_back(static_cast<double>(bin.periods));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// Indices of the variants with a chart, ascending: at most kMostPanels, preferring those with an
/// exceeded certificate.
std::vector<std::size_t> variants_with_a_chart(const CampaignStatistics& statistics) {
  const auto is_exceeded = [&](std::size_t n) {
    return std::ranges::any_of(statistics.variants[n].calibration, &CalibrationBin::exceeded);
  };
  std::vector<std::size_t> places(statistics.variants.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_partition(places.begin(), places.end(), is_exceeded);
  places.resize(std::min(places.size(), kMostPanels));
  std::ranges::sort(places);
  return places;
}

CampaignFigure reliability_figure(const CampaignStatistics& statistics) {
  CampaignFigure figure{.file = kReliabilityFile, .charts = {}};
  const double least = least_certified(statistics);
  figure.charts.push_back(reliability_chart({.title = "Do the certificates hold?",
                                             .certified = statistics.calibration,
                                             .published = statistics.published,
                                             .no_bound = no_bound_words(statistics),
                                             .none_holds = none_is_bound(statistics)},
                                            least));
  figure.charts.push_back(period_chart(statistics));
  if (statistics.variants.size() == 1) return figure;
  const std::vector<std::size_t> panels = variants_with_a_chart(statistics);
  if (panels.size() < statistics.variants.size()) {
    figure.charts[0].note += fmt::format(
        " Of {} variants, {} have their own chart: those with exceeded bins first, then the others "
        "in order.",
        statistics.variants.size(), panels.size());
  }
  for (const std::size_t n : panels) {
    const VariantStatistics& variant = statistics.variants[n];
    figure.charts.push_back(reliability_chart(
        {.title = numbered_name(statistics, n, kTitleLimit) +
                  (variant.no_bound.empty() ? "" : ": NO BOUND"),
         .certified = variant.calibration,
         .published = variant.published,
         .no_bound = variant.no_bound.empty() ? "" : " No bound: " + variant.no_bound + ".",
         .none_holds = !variant.no_bound.empty()},
        least));
  }
  return figure;
}

/// The legend of the variants' numbers.
std::string variant_list(const CampaignStatistics& statistics) {
  std::string list;
  const std::size_t count = statistics.variants.size();
  for (std::size_t n = 0; n < std::min(count, kMostListed); ++n) {
    list += (n == 0 ? "" : "; ") + numbered_name(statistics, n, kNameLimit);
  }
  return list + (count > kMostListed ? "; …" : ".");
}

/// A chart of the items `names` at x = 1, 2, …
Chart named_chart(const std::string& title, std::vector<std::string> names) {
  const auto count = static_cast<double>(names.size());
  return {.title = title,
          .note = kListedBefore,
          .x_label = "",
          .y_label = "",
          .x_names = std::move(names),
          .x_includes = {1.0 - kRoom, count + kRoom}};
}

std::vector<std::string> pair_numbers(const CampaignStatistics& statistics) {
  std::vector<std::string> numbers;
  for (const VariantDifference& difference : statistics.differences) {
    numbers.push_back(fmt::format("{} − {}", statistics.variants[difference.pair.variant].id,
                                  statistics.variants[difference.pair.baseline].id));
  }
  return thinned(std::move(numbers), kMostPairs);
}

/// `rate` of each variant with its interval, offset by `beside` from its number.
Series rate_series(const CampaignStatistics& statistics, const std::string& name, int colour,
                   EpisodeRate VariantStatistics::*rate, double beside) {
  Series series{.name = name, .colour = colour, .mark = Mark::kPoints};
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const EpisodeRate& own = statistics.variants[n].*rate;
    series.x.push_back(static_cast<double>(n + 1) + beside);
    series.y.push_back(own.rate);
    series.lower.push_back(own.interval.lower);
    series.upper.push_back(own.interval.upper);
  }
  return series;
}

/// For a single variant: one point per outcome.
CampaignFigure outcomes_of_one(const CampaignStatistics& statistics) {
  const std::vector<ListedOutcome> outcomes = outcomes_of(statistics.variants);
  Chart chart = named_chart("What became of the drives (99 % intervals)", {});
  chart.note = variant_list(statistics);
  chart.y_label = "share of drives (–)";
  chart.x_includes = {1.0 - kRoom, static_cast<double>(outcomes.size()) + kRoom};
  chart.y_includes = {0.0};
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    const EpisodeRate& rate = statistics.variants.front().*outcomes[n].rate;
    chart.x_names.push_back(outcomes[n].title);
    chart.series.push_back({.name = outcomes[n].title,
                            .colour = outcome_colour(outcomes[n].name),
                            .mark = Mark::kPoints,
                            .x = {static_cast<double>(n + 1)},
                            .y = {rate.rate},
                            .lower = {rate.interval.lower},
                            .upper = {rate.interval.upper}});
  }
  return {.file = kOutcomesFile, .charts = {std::move(chart)}};
}

CampaignFigure outcome_figure(const CampaignStatistics& statistics) {
  if (statistics.variants.size() == 1) return outcomes_of_one(statistics);
  const std::vector<std::string> numbers = variant_numbers(statistics);
  Chart reached = named_chart("Drives that reached the target (99 % intervals)", numbers);
  reached.note = variant_list(statistics);
  reached.x_label = "variant";
  reached.y_label = "share of drives (–)";
  reached.series.push_back(
      rate_series(statistics, "reached", kGreen, &VariantStatistics::reached, 0.0));
  Chart failed = named_chart("Drives that did not reach it safely (99 % intervals)", numbers);
  failed.x_label = "variant";
  failed.y_label = "share of drives (–)";
  failed.y_includes = {0.0};
  const std::vector<ListedOutcome> outcomes = outcomes_of(statistics.variants);
  double beside = -0.5 * kBeside * static_cast<double>(outcomes.size() - 2);
  for (std::size_t n = 1; n < outcomes.size(); ++n) {  // all except those that reached it
    failed.series.push_back(rate_series(
        statistics, outcomes[n].title, outcome_colour(outcomes[n].name), outcomes[n].rate, beside));
    beside += kBeside;
  }
  return {.file = kOutcomesFile, .charts = {std::move(reached), std::move(failed)}};
}

/// Title and unit of a quantity of paired_quantities.
std::pair<std::string, std::string> quantity_texts(const std::string& quantity) {
  if (quantity == "reached") return {"Reached the target", "difference in share (–)"};
  if (quantity == "unsafe") return {"Entered the unsafe set", "difference in share (–)"};
  if (quantity == "cost") return {"Cost", "mean difference (–)"};
  if (quantity == "min_clearance") return {"Least clearance", "mean difference (m)"};
  if (quantity == "certified") return {"Next-step certificate", "mean difference (–)"};
  return {"Evaluations per plan", "mean difference (–)"};
}

CampaignFigure difference_figure(const CampaignStatistics& statistics) {
  const std::vector<std::string> numbers = pair_numbers(statistics);
  CampaignFigure figure{.file = kDifferencesFile, .charts = {}};
  for (std::size_t quantity = 0; quantity < paired_quantities().size(); ++quantity) {
    const auto [title, label] = quantity_texts(paired_quantities()[quantity]);
    Chart chart = named_chart(title + ", seed by seed (99 % intervals)", numbers);
    if (quantity == 0) chart.note = variant_list(statistics);
    chart.x_label = "variant − baseline";
    chart.y_label = label;
    chart.rules.push_back({.name = "no difference", .value = 0.0});
    Series series{.name = "mean of the differences", .colour = kBlue, .mark = Mark::kPoints};
    for (std::size_t n = 0; n < statistics.differences.size(); ++n) {
      const MeanDifference& mean = statistics.differences[n].quantities[quantity];
      series.x.push_back(static_cast<double>(n + 1));
      series.y.push_back(mean.mean);
      series.lower.push_back(mean.interval.lower);
      series.upper.push_back(mean.interval.upper);
    }
    chart.series.push_back(std::move(series));
    figure.charts.push_back(std::move(chart));
  }
  return figure;
}

}  // namespace

std::vector<CampaignFigure> campaign_figures(const CampaignStatistics& statistics) {
  std::vector<CampaignFigure> figures = {outcome_figure(statistics),
                                         reliability_figure(statistics)};
  if (!statistics.differences.empty()) figures.push_back(difference_figure(statistics));
  std::vector<Chart> distributions = distribution_charts(statistics);
  if (!distributions.empty()) {
    figures.push_back({.file = kDistributionsFile, .charts = std::move(distributions)});
  }
  std::vector<Chart> tradeoff = tradeoff_charts(statistics);
  if (!tradeoff.empty()) figures.push_back({.file = kTradeoffFile, .charts = std::move(tradeoff)});
  std::vector<Chart> rare = rare_charts(statistics);
  if (!rare.empty()) figures.push_back({.file = kRareFile, .charts = std::move(rare)});
  return figures;
}

}  // namespace qsmpc::harness
