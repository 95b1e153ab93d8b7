#include "harness/campaign/statistics/statistics.hpp"

#include <functional>

#include "harness/errors.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace {

Distribution planning_times(const StoreReader& store, std::int64_t variant, std::int64_t periods) {
  SortedDistribution times(periods);
  store.for_each_sorted_ocp_ms(variant, [&](double ms) { times.add(ms); });
  return times.result();
}

Spread spread_of(const StoreReader& store, std::int64_t variant, EpisodeNumber number,
                 const SpreadTally& tally) {
  return tally.result([&](const std::function<void(double)>& visit) {
    store.for_each_sorted(variant, number, visit);
  });
}

VariantTally tally_of(const StoreReader& store, std::int64_t variant) {
  VariantTally tally;
  store.for_each_episode(variant, [&](const EpisodeRow& row) { tally.add(row); });
  store.for_each_period(variant, [&](std::uint64_t /*seed*/, std::int64_t period,
                                     const PeriodRow& row) { tally.add(period, row); });
  return tally;
}

/// As why_no_bound of what was driven, which needs no file any more.
std::string no_bound_of(const StoredVariant& variant) {
  try {
    return why_no_bound(
        parse_scenario(variant.scenario_text, {.file = variant.name, .files_must_exist = false}));
  } catch (const InputError& error) {
    // Of another version, which took what this one refuses.
    return std::string("whether they hold is not known: ") + error.what();
  }
}

VariantStatistics statistics_of(const StoreReader& store, const StoredVariant& variant,
                                const VariantTally& tally) {
  VariantStatistics statistics = tally.result();
  statistics.id = variant.id;
  statistics.name = variant.name;
  statistics.scenario = variant.scenario;
  statistics.settings = variant.settings;
  statistics.plant = variant.plant;
  statistics.scenario_text = variant.scenario_text;
  statistics.no_bound = no_bound_of(variant);
  statistics.episodes = store.campaign().episodes / std::ssize(store.variants());
  statistics.cost = spread_of(store, variant.id, EpisodeNumber::kCost, tally.cost());
  statistics.min_clearance =
      spread_of(store, variant.id, EpisodeNumber::kMinClearance, tally.min_clearance());
  statistics.time_to_target =
      spread_of(store, variant.id, EpisodeNumber::kTimeToTarget, tally.time_to_target());
  statistics.ocp_ms = planning_times(store, variant.id, statistics.periods);
  store.for_each_path(variant.id, kMostDrawnPaths,
                      [&](const std::string& outcome, const std::vector<PathPoint>& path) {
                        statistics.paths.push_back({.outcome = outcome, .points = path});
                      });
  statistics.rare = rare_statistics(store, variant.id);
  return statistics;
}

VariantDifference difference_of(const StoreReader& store, const VariantPair& pair) {
  PairedDifference difference;
  store.for_each_pair(store.variants()[pair.baseline].id, store.variants()[pair.variant].id,
                      [&](const EpisodeRow& baseline, const EpisodeRow& variant) {
                        difference.add(baseline, variant);
                      });
  return {.pair = pair, .quantities = difference.result()};
}

}  // namespace

CampaignStatistics campaign_statistics(const StoreReader& store) {
  CampaignStatistics statistics{.campaign = store.campaign(), .outcomes = store.outcomes()};
  PooledCalibration certified;
  PooledCalibration published;
  for (const StoredVariant& variant : store.variants()) {
    const VariantTally tally = tally_of(store, variant.id);
    statistics.variants.push_back(statistics_of(store, variant, tally));
    statistics.done += statistics.variants.back().done;
    certified.add(tally.calibration());
    published.add(tally.published());
  }
  for (const VariantPair& pair : variant_pairs(store.variants())) {
    statistics.differences.push_back(difference_of(store, pair));
  }
  statistics.calibration = certified.result();
  statistics.published = published.result();
  statistics.p_value = certified.p_value();
  statistics.tradeoff = tradeoff_panels(store);
  return statistics;
}

}  // namespace qsmpc::harness
