#include "harness/report/campaign_drives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/ground_map.hpp"
#include "harness/figures/palette.hpp"
#include "harness/report/driven_ways.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/text/printable.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kMostNoBound = 12;  // most variants that are listed as having no bound

constexpr std::size_t kMostMaps = 12;
constexpr std::size_t kMostAxisNumbers = 20;  // most numbers with room below an axis
constexpr std::size_t kMapNameLimit = 44;     // bytes of a variant's name
// Most paths of one outcome that are drawn strongly; fewer of those that arrived, so that the
// others stay visible.
constexpr std::size_t kMostProminent = 30;
constexpr std::size_t kMostProminentArrived = 8;
constexpr std::size_t kReasonLimit = 200;
constexpr double kSideRoom = 0.5;       // margin left and right of the outer variants
constexpr std::size_t kRangeBegin = 1;  // index into spread_shares
constexpr std::size_t kMiddle = 3;      // index into spread_shares
constexpr std::size_t kRangeEnd = 5;

/// The colours of the bars in web/tables.css.
constexpr std::array<std::pair<const char*, int>, 6> kOutcomeColours = {{{"reached", kGreen},
                                                                         {"collision", kVermilion},
                                                                         {"left_bounds", kPurple},
                                                                         {"timeout", kBlue},
                                                                         {"fault", kOrange},
                                                                         {kLeftSafeSet, kSky}}};

/// Indices of the variants that have paths and get a map.
std::vector<std::size_t> variants_with_a_map(const CampaignStatistics& statistics) {
  std::vector<std::size_t> places;
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    if (!statistics.variants[n].paths.empty()) places.push_back(n);
  }
  std::ranges::stable_sort(places, std::ranges::greater(),
                           [&](std::size_t n) { return statistics.variants[n].unsafe.events; });
  places.resize(std::min(places.size(), kMostMaps));
  std::ranges::sort(places);
  return places;
}

/// Ground and axes of the map. Throws whatever parsing the scenario or loading its model throws.
PlaneMap ground_of(const VariantStatistics& variant) {
  const Scenario scenario = parse_scenario(
      variant.scenario_text,
      {.file = "variant " + variant.name, .files_must_exist = false, .is_recorded = true});
  PlaneMap map = ground_map(standing_scenario(scenario), system_of(scenario));
  map.movers = written_movers(scenario.safe_set);
  return map;
}

/// Adds the paths of a variant; drives that arrived lie below the others.
void add_paths(const VariantStatistics& variant, PlaneMap& map) {
  std::map<std::string, std::size_t> counts;
  for (const DrivenPath& path : variant.paths) ++counts[path.outcome];
  for (auto drive = variant.paths.rbegin(); drive != variant.paths.rend(); ++drive) {
    const bool arrived = drive->outcome == outcome_name(Outcome::kReached);
    std::string words = drive->outcome;
    std::ranges::replace(words, '_', ' ');
    MapPath path{
        .name = fmt::format("{} ({})", words, counts[drive->outcome]),
        .colour = outcome_colour(drive->outcome),
        .faint = counts[drive->outcome] > (arrived ? kMostProminentArrived : kMostProminent),
        .end_mark = arrived ? MapMark::kNone : MapMark::kDot};
    for (const PathPoint& point : drive->points)
      path.points.push_back({.x = point.x, .y = point.y});
    map.paths.push_back(std::move(path));
  }
}

std::string drawn_text(const VariantStatistics& variant) {
  const std::int64_t drawn = std::ssize(variant.paths);
  if (drawn == variant.done && variant.reached.events == variant.done) return {};
  if (drawn == variant.done) return "Dots mark the ends of drives that did not reach the target.";
  return fmt::format(
      "{} of {} drives are drawn, starting with those that were unsafe or did not reach the "
      "target, which end in a dot{}.",
      drawn, variant.done,
      drawn < kMostDrawnPaths ? "; the others are from an earlier version, which stored no paths"
                              : "");
}

/// How the distribution of a quantity of the drives is drawn.
struct Quantity {
  const char* title;
  const char* note;
  const char* label;
  Spread VariantStatistics::*spread;
};

Chart by_share(const CampaignStatistics& statistics, const Quantity& quantity) {
  Chart chart{.title = quantity.title,
              .note = quantity.note,
              .x_label = quantity.label,
              .y_label = "share of drives at or below (–)",
              .y_includes = {0.0, 1.0}};
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const std::vector<double>& curve = (statistics.variants[n].*quantity.spread).curve;
    Series series{.name = statistics.variants.size() == 1
                              ? "drives"
                              : numbered_name(statistics, n, kMapNameLimit),
                  .colour = static_cast<int>(n)};
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (!std::isfinite(curve[i])) continue;
      series.x.push_back(curve[i]);
      series.y.push_back(curve_shares()[i]);
    }
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart by_variant(const CampaignStatistics& statistics, const Quantity& quantity) {
  const auto count = static_cast<double>(statistics.variants.size());
  Chart chart{.title = quantity.title,
              .note = std::string("Median, and the range from the 5th to the 95th percentile. ") +
                      quantity.note,
              .x_label = "variant",
              .y_label = quantity.label,
              .x_names = variant_numbers(statistics),
              .x_includes = {1.0 - kSideRoom, count + kSideRoom}};
  Series series{.name = "drives", .colour = kBlue, .mark = Mark::kPoints};
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const std::vector<double>& quantiles = (statistics.variants[n].*quantity.spread).quantiles;
    if (!std::isfinite(quantiles[kMiddle])) continue;
    series.x.push_back(static_cast<double>(n + 1));
    series.y.push_back(quantiles[kMiddle]);
    series.lower.push_back(quantiles[kRangeBegin]);
    series.upper.push_back(quantiles[kRangeEnd]);
  }
  if (!series.x.empty()) chart.series.push_back(std::move(series));
  return chart;
}

}  // namespace

int outcome_colour(const std::string& outcome) {
  const auto found = std::ranges::find_if(
      kOutcomeColours, [&](const auto& entry) { return outcome == entry.first; });
  return found == kOutcomeColours.end() ? kGrey : found->second;
}

std::string numbered_name(const CampaignStatistics& statistics, std::size_t place,
                          std::size_t limit) {
  const VariantStatistics& variant = statistics.variants[place];
  return fmt::format("{}: {}", variant.id, printable(variant.name, limit));
}

std::vector<std::string> thinned(std::vector<std::string> names, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, (names.size() + most - 1) / most);
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (n % stride != 0) names[n].clear();
  }
  return names;
}

bool none_is_bound(const CampaignStatistics& statistics) {
  const auto& variants = statistics.variants;
  return !variants.empty() && std::ranges::none_of(variants, [](const auto& variant) {
    return variant.no_bound.empty();
  });
}

std::string no_bound_words(const CampaignStatistics& statistics) {
  std::string ids;
  std::string why;
  std::size_t count = 0;
  for (const VariantStatistics& variant : statistics.variants) {
    if (variant.no_bound.empty()) continue;
    if (count > 0 && count <= kMostNoBound) ids += ", ";
    if (count < kMostNoBound) ids += fmt::format("{}", variant.id);
    if (count == kMostNoBound) ids += "…";
    why = variant.no_bound;
    ++count;
  }
  if (count == 0) return {};
  if (count == statistics.variants.size()) return fmt::format(" No bound: {}.", why);
  return fmt::format(" No bound in variant{} {}: {}.", count == 1 ? "" : "s", ids, why);
}

std::vector<std::string> variant_numbers(const CampaignStatistics& statistics) {
  std::vector<std::string> numbers;
  for (const VariantStatistics& variant : statistics.variants) {
    numbers.push_back(fmt::format("{}", variant.id));
  }
  return thinned(std::move(numbers), kMostAxisNumbers);
}

bool has_places(const Chart& chart) {
  std::set<double> places;
  for (const Series& series : chart.series) {
    if (series.dashed) continue;
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (is_drawable(series.x[i]) && is_drawable(series.y[i])) places.insert(series.x[i]);
    }
  }
  return places.size() > 1;
}

DriveMaps drive_maps(const CampaignStatistics& statistics) {
  DriveMaps drives;
  const std::vector<std::size_t> places = variants_with_a_map(statistics);
  for (const std::size_t n : places) {
    const VariantStatistics& variant = statistics.variants[n];
    const std::string name = numbered_name(statistics, n, kMapNameLimit);
    try {
      PlaneMap map = ground_of(variant);
      map.title = statistics.variants.size() == 1 ? "All drives" : name;
      map.note = drawn_text(variant);
      add_paths(variant, map);
      drives.maps.push_back(std::move(map));
    } catch (const std::exception& error) {  // e.g. the library of its model is missing
      drives.notes.push_back(
          fmt::format("No map of variant {}: {}", name, printable(error.what(), kReasonLimit)));
    }
  }
  if (places.size() == kMostMaps && statistics.variants.size() > kMostMaps) {
    drives.notes.push_back(
        fmt::format("Of {} variants, only the {} with the most unsafe drives have a map.",
                    statistics.variants.size(), kMostMaps));
  }
  return drives;
}

std::vector<Chart> distribution_charts(const CampaignStatistics& statistics) {
  const std::array quantities = {
      Quantity{"Cost", "Drives that faulted have no cost.", "cost of a drive (–)",
               &VariantStatistics::cost},
      Quantity{"Least clearance", "Of the true state along a drive; unsafe at 0 and below.",
               "least clearance (m)", &VariantStatistics::min_clearance},
      Quantity{"Time to the target", "Of the drives that reached it.", "time (s)",
               &VariantStatistics::time_to_target}};
  std::vector<Chart> charts;
  for (const Quantity& quantity : quantities) {
    Chart chart = statistics.variants.size() <= kPaletteSize ? by_share(statistics, quantity)
                                                             : by_variant(statistics, quantity);
    if (has_places(chart)) charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace qsmpc::harness
