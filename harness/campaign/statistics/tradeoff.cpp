#include "harness/campaign/statistics/tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>

#include "harness/campaign/statistics/paired_difference.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {
namespace {

ReachedCost reached_cost(const StoreReader& store, std::int64_t variant) {
  BootstrapMean cost;
  Eigen::ArrayXd weights;
  store.for_each_episode(variant, [&](const EpisodeRow& row) {
    if (row.outcome != outcome_name(Outcome::kReached) || !std::isfinite(row.cost)) return;
    poisson_weights(row.seed, weights);
    cost.add(row.cost, weights);
  });
  return {.drives = cost.count(), .mean = cost.mean(), .interval = cost.interval()};
}

/// The panel of the scenario and plant of `variant`, which is added where it is new.
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
    std::optional<ReachedCost> cost;  // of a variant that several families have, read once
    for (std::size_t f = 0; f < families.size(); ++f) {
      if (std::ranges::find(families[f].settings, variant.settings) == families[f].settings.end()) {
        continue;
      }
      if (!cost) cost = reached_cost(store, variant.id);
      panel.families[f].points.push_back({.variant = n, .cost = *cost});
    }
  }
  for (TradeoffPanel& panel : panels) {
    for (std::size_t f = 0; f < families.size(); ++f) {
      std::ranges::sort(panel.families[f].points, {}, [&](const TradeoffPoint& point) {
        return std::ranges::find(families[f].settings, store.variants()[point.variant].settings) -
               families[f].settings.begin();
      });
    }
  }
  return panels;
}

}  // namespace qsmpc::harness
