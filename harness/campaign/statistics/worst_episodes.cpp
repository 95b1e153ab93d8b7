#include "harness/campaign/statistics/worst_episodes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

double or_else(double value, double worst) { return std::isnan(value) ? worst : value; }

/// Smaller for a worse episode.
auto rank_of(const EpisodeRow& row) {
  const bool is_grave = row.unsafe || row.outcome == outcome_name(Outcome::kFault);
  return std::tuple(is_grave ? 0 : 1, or_else(row.min_clearance, -kInfinity),
                    -or_else(row.cost, kInfinity), row.variant, row.seed);
}

}  // namespace

bool is_worse(const EpisodeRow& one, const EpisodeRow& other) {
  return rank_of(one) < rank_of(other);
}

std::vector<EpisodeRow> worst_episodes(const StoreReader& store, std::size_t count) {
  std::vector<EpisodeRow> worst;  // a heap with the best one in front
  for (const StoredVariant& variant : store.variants()) {
    store.for_each_episode(variant.id, [&](const EpisodeRow& row) {
      if (worst.size() == count) {
        if (count == 0 || !is_worse(row, worst.front())) return;
        std::pop_heap(worst.begin(), worst.end(), is_worse);
        worst.pop_back();
      }
      worst.push_back(row);
      std::push_heap(worst.begin(), worst.end(), is_worse);
    });
  }
  std::sort_heap(worst.begin(), worst.end(), is_worse);
  return worst;
}

}  // namespace qsmpc::harness
