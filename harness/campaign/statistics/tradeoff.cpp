#include "harness/campaign/statistics/tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>

#include "harness/campaign/statistics/paired_difference.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {
namespace {

DriveMean mean_of(const BootstrapMean& mean) {
  return {.drives = mean.count(), .mean = mean.mean(), .interval = mean.interval()};
}

/// The point of the variant with index `place` and store id `id`.
TradeoffPoint point_of(const StoreReader& store, std::size_t place, std::int64_t id) {
  BootstrapMean cost;
  BootstrapMean certified;
  Eigen::ArrayXd weights;
  store.for_each_episode(id, [&](const EpisodeRow& row) {
    poisson_weights(row.seed, weights);
    if (std::isfinite(row.next_step_sum)) certified.add(row.next_step_sum, weights);
    if (row.outcome != outcome_name(Outcome::kReached) || !std::isfinite(row.cost)) return;
    cost.add(row.cost, weights);
  });
  return {.variant = place, .cost = mean_of(cost), .certified = mean_of(certified)};
}

/// The panel for the scenario and plant of `variant`, added if it is new.
TradeoffPanel& panel_of(const StoredVariant& variant, const std::vector<VariantFamily>& families,
                        std::vector<TradeoffPanel>& panels) {
  const auto found = std::ranges::find_if(panels, [&](const TradeoffPanel& panel) {
    return panel.scenario == variant.scenario && panel.plant == variant.plant;
  });
  if (found != panels.end()) return *found;
  panels.push_back({.scenario = variant.scenario, .plant = variant.plant});
  for (const VariantFamily& family : families) {
    panels.back().families.push_back({.name = family.name});
  }
  return panels.back();
}

}  // namespace

std::vector<TradeoffPanel> tradeoff_panels(const StoreReader& store) {
  const std::vector<VariantFamily>& families = store.campaign().risk_against_cost;
  if (families.empty()) return {};
  std::vector<TradeoffPanel> panels;
  for (std::size_t n = 0; n < store.variants().size(); ++n) {
    const StoredVariant& variant = store.variants()[n];
    TradeoffPanel& panel = panel_of(variant, families, panels);
    std::optional<TradeoffPoint> point;  // read once for a variant in several families
    for (std::size_t f = 0; f < families.size(); ++f) {
      if (std::ranges::find(families[f].settings, variant.settings) == families[f].settings.end()) {
        continue;
      }
      if (!point) point = point_of(store, n, variant.id);
      panel.families[f].points.push_back(*point);
    }
  }
  for (TradeoffPanel& panel : panels) {
    for (std::size_t f = 0; f < families.size(); ++f) {
      std::ranges::sort(panel.families[f].points, {}, [&](const TradeoffPoint& one) {
        return std::ranges::find(families[f].settings, store.variants()[one.variant].settings) -
               families[f].settings.begin();
      });
    }
  }
  return panels;
}

}  // namespace qsmpc::harness
