#include "controller/certification/worst_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace qsmpc {
namespace {

/// Moves mass in the order of its unit cost until `budget` is spent; returns the mass moved.
double greedy_transport(const Eigen::Ref<const Eigen::VectorXd>& unit_costs,
                        const Eigen::Ref<const Eigen::VectorXd>& weights, double budget) {
  std::vector<Eigen::Index> order(unit_costs.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) {
    return unit_costs[a] != unit_costs[b] ? unit_costs[a] < unit_costs[b] : a < b;
  });
  double moved = 0.0;
  for (const Eigen::Index i : order) {
    const double cost = unit_costs[i] * weights[i];
    // Mass infinitely far away cannot be moved at all, not even none of it at cost 0 · ∞.
    if (std::isinf(unit_costs[i])) break;
    if (cost > budget) return std::min(1.0, moved + budget / unit_costs[i]);
    budget -= cost;
    moved += weights[i];
  }
  return std::min(1.0, moved);
}

/// Algorithm 3 with p = 2; unbounded dimensions have no faces and do not count.
double thesis_distance(const Eigen::Ref<const Eigen::VectorXd>& point, const Box& bounds) {
  double squares = 0.0;
  bool bounded = false;
  for (Eigen::Index axis = 0; axis < point.size(); ++axis) {
    const double nearest =
        std::min(point[axis] - bounds.lower[axis], bounds.upper[axis] - point[axis]);
    if (nearest < 0.0) return 0.0;
    if (std::isinf(nearest)) continue;
    squares += nearest * nearest;
    bounded = true;
  }
  return bounded ? std::sqrt(squares) : std::numeric_limits<double>::infinity();
}

/// Of every point to the unsafe set.
Eigen::VectorXd distances_of(const DiscreteMeasure& measure, const SafeSet& safe_set) {
  Eigen::VectorXd distances(measure.size());
  for (Eigen::Index i = 0; i < measure.size(); ++i) {
    distances[i] = distance_to_unsafe(measure.locations.col(i), safe_set);
  }
  return distances;
}

}  // namespace

double worst_case_probability(const Eigen::Ref<const Eigen::VectorXd>& distances,
                              const Eigen::Ref<const Eigen::VectorXd>& weights, double radius) {
  if (distances.size() != weights.size()) {
    throw std::invalid_argument("worst case: as many distances as weights are needed");
  }
  if (!(distances.array() >= 0.0).all() || !(weights.array() >= 0.0).all()) {
    throw std::invalid_argument("worst case: distances and weights must not be negative");
  }
  if (!(radius >= 0.0)) throw std::invalid_argument("worst case: the radius must not be negative");
  const double budget = radius * radius;
  if (std::isinf(budget)) return 1.0;
  return greedy_transport(distances.cwiseAbs2(), weights, budget);
}

double worst_case_probability(const DiscreteMeasure& measure, const SafeSet& safe_set,
                              double radius) {
  return worst_case_probability(distances_of(measure, safe_set), measure.weights, radius);
}

double linear_transport_probability(const DiscreteMeasure& measure, const SafeSet& safe_set,
                                    double radius) {
  return greedy_transport(distances_of(measure, safe_set), measure.weights, radius);
}

double thesis_probability(const DiscreteMeasure& measure, const SafeSet& safe_set, double radius) {
  Eigen::VectorXd distances(measure.size());
  for (Eigen::Index i = 0; i < measure.size(); ++i) {
    distances[i] = thesis_distance(measure.locations.col(i), safe_set.bounds);
  }
  return greedy_transport(distances, measure.weights, radius);
}

}  // namespace qsmpc
