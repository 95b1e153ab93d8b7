#include "harness/campaign/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "harness/errors.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/statistics/rank_selection.hpp"

namespace qsmpc::harness {
namespace {

/// The spread of a number of a variant's episodes, from the kept values, or from the store if there
/// are too many to keep.
Spread spread_of(const StoreReader& store, std::int64_t variant, EpisodeNumber number,
                 const SpreadTally& tally, KeptValues& kept) {
  return tally.result([&](const std::function<void(double)>& visit) {
    if (kept.has_all()) {
      std::ranges::for_each(kept.sorted(), visit);
    } else {
      store.for_each_sorted(variant, number, visit);
    }
  });
}

/// The data read for one variant.
struct ReadVariant {
  KeptValues ocp_ms{};
  VariantTally tally{};
  KeptValues cost{};
  KeptValues min_clearance{};
  KeptValues time_to_target{};
};

ReadVariant read_variant(const StoreReader& store, std::int64_t variant) {
  ReadVariant read;
  store.for_each_episode(variant, [&](const EpisodeRow& row) {
    read.tally.add(row);
    if (row.outcome == outcome_name(Outcome::kFault)) return;
    if (!std::isnan(row.cost)) read.cost.add(row.cost);
    if (!std::isnan(row.min_clearance)) read.min_clearance.add(row.min_clearance);
    if (row.time_to_target) read.time_to_target.add(*row.time_to_target);
  });
  store.for_each_period(variant,
                        [&](std::uint64_t /*seed*/, std::int64_t period, const PeriodRow& row) {
                          read.tally.add(period, row);
                          read.ocp_ms.add(row.ocp_ms);
                        });
  return read;
}

/// why_no_bound of the stored scenario; needs none of its files.
std::string no_bound_of(const StoredVariant& variant) {
  try {
    return why_no_bound(
        parse_scenario(variant.scenario_text, {.file = variant.name, .files_must_exist = false}));
  } catch (const InputError& error) {
    // Stored by another version, which accepted what this one refuses.
    return std::string("whether they hold is not known: ") + error.what();
  }
}

VariantStatistics statistics_of(const StoreReader& store, const StoredVariant& variant,
                                ReadVariant& read) {
  const VariantTally& tally = read.tally;
  VariantStatistics statistics =
      tally.result(store.campaign().until ? Counted::kStopped : Counted::kFixed);
  statistics.id = variant.id;
  statistics.name = variant.name;
  statistics.scenario = variant.scenario;
  statistics.settings = variant.settings;
  statistics.plant = variant.plant;
  statistics.scenario_text = variant.scenario_text;
  statistics.no_bound = no_bound_of(variant);
  statistics.episodes = store.campaign().episodes / std::ssize(store.variants());
  const auto spread = [&](EpisodeNumber number, const SpreadTally& counted, KeptValues& kept) {
    return spread_of(store, variant.id, number, counted, kept);
  };
  statistics.cost = spread(EpisodeNumber::kCost, tally.cost(), read.cost);
  statistics.min_clearance =
      spread(EpisodeNumber::kMinClearance, tally.min_clearance(), read.min_clearance);
  statistics.time_to_target =
      spread(EpisodeNumber::kTimeToTarget, tally.time_to_target(), read.time_to_target);
  statistics.ocp_ms = read.ocp_ms.distribution(
      [&](const std::function<void(double)>& visit) { store.for_each_ocp_ms(variant.id, visit); });
  store.for_each_path(variant.id, kMostDrawnPaths,
                      [&](const std::string& outcome, const std::vector<PathPoint>& path) {
                        statistics.paths.push_back({.outcome = outcome, .points = path});
                      });
  statistics.rare = rare_statistics(store, variant.id);
  return statistics;
}

/// How many variants are read concurrently; each takes an SQL statement.
constexpr std::size_t kVariantsAtOnce = 64;

/// Adds the differences of `pairs`, of at most kVariantsAtOnce variants or a single one.
void add_differences(const StoreReader& store, const std::vector<VariantPair>& pairs,
                     std::vector<VariantDifference>& differences) {
  std::map<std::size_t, std::size_t> places;  // by variant: its index among those read
  for (const VariantPair& pair : pairs) {
    places.try_emplace(pair.baseline, 0);
    places.try_emplace(pair.variant, 0);
  }
  std::vector<std::int64_t> ids;
  for (auto& [variant, place] : places) {
    place = ids.size();
    ids.push_back(store.variants()[variant].id);
  }
  std::vector<PairedDifference> tallies(pairs.size());
  Eigen::ArrayXd weights;
  store.for_each_seed(ids, [&](std::uint64_t seed, const std::vector<const EpisodeRow*>& rows) {
    poisson_weights(seed, weights);  // once for all pairs
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const EpisodeRow* baseline = rows[places.at(pairs[n].baseline)];
      const EpisodeRow* variant = rows[places.at(pairs[n].variant)];
      if (baseline != nullptr && variant != nullptr) tallies[n].add(*baseline, *variant, weights);
    }
  });
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    differences.push_back({.pair = pairs[n], .quantities = tallies[n].result()});
  }
}

std::vector<VariantDifference> differences_of(const StoreReader& store) {
  std::vector<VariantDifference> differences;
  std::vector<VariantPair> pairs;  // read together
  std::set<std::size_t> variants;  // in `pairs`
  for (const VariantPair& pair : variant_pairs(store.variants())) {
    variants.insert({pair.baseline, pair.variant});
    if (variants.size() > kVariantsAtOnce) {
      add_differences(store, pairs, differences);
      pairs.clear();
      variants = {pair.baseline, pair.variant};
    }
    pairs.push_back(pair);
  }
  if (!pairs.empty()) add_differences(store, pairs, differences);
  return differences;
}

}  // namespace

CampaignStatistics campaign_statistics(const StoreReader& store) {
  CampaignStatistics statistics{.campaign = store.campaign(), .outcomes = store.outcomes()};
  PooledCalibration certified;
  PooledCalibration published;
  for (const StoredVariant& variant : store.variants()) {
    ReadVariant read = read_variant(store, variant.id);
    statistics.variants.push_back(statistics_of(store, variant, read));
    statistics.done += statistics.variants.back().done;
    certified.add(read.tally.calibration());
    published.add(read.tally.published());
  }
  statistics.differences = differences_of(store);
  statistics.calibration = certified.result();
  statistics.published = published.result();
  statistics.p_value = certified.p_value();
  statistics.tradeoff = tradeoff_panels(store);
  return statistics;
}

}  // namespace qsmpc::harness
