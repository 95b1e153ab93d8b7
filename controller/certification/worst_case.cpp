#include "controller/certification/worst_case.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace qsmpc::controller {
double transported_mass(const Eigen::Ref<const Eigen::VectorXd>& unit_costs,
                        const Eigen::Ref<const Eigen::VectorXd>& weights, double budget) {
  // If the budget suffices for all movable mass, the order does not matter.
  double all_costs = 0.0;
  double all_mass = 0.0;
  for (Eigen::Index i = 0; i < unit_costs.size(); ++i) {
    if (std::isinf(unit_costs[i])) continue;
    all_costs += unit_costs[i] * weights[i];
    all_mass += weights[i];
  }
  if (all_costs <= budget) return std::min(1.0, all_mass);
  // A heap sorts only the nearest points, as far as the budget reaches.
  std::vector<std::pair<double, double>> heap;  // unit cost and mass
  heap.reserve(unit_costs.size());
  for (Eigen::Index i = 0; i < unit_costs.size(); ++i) {
    // Mass infinitely far away cannot be moved; weights of zero must not cost 0 · ∞ either.
    if (!std::isinf(unit_costs[i])) heap.emplace_back(unit_costs[i], weights[i]);
  }
  std::make_heap(heap.begin(), heap.end(), std::greater<>());
  double moved = 0.0;
  for (; !heap.empty(); heap.pop_back()) {
    std::pop_heap(heap.begin(), heap.end(), std::greater<>());
    const auto [unit_cost, mass] = heap.back();
    const double cost = unit_cost * mass;
    if (cost > budget) return std::min(1.0, moved + budget / unit_cost);
    budget -= cost;
    moved += mass;
  }
  return std::min(1.0, moved);
}

double worst_case_probability(const Eigen::Ref<const Eigen::VectorXd>& distances,
                              const Eigen::Ref<const Eigen::VectorXd>& weights, double radius) {
  if (distances.size() != weights.size()) {
    throw std::invalid_argument("worst case: the numbers of distances and weights must be equal");
  }
  if (!(distances.array() >= 0.0).all() || !(weights.array() >= 0.0).all()) {
    throw std::invalid_argument("worst case: distances and weights must not be negative");
  }
  if (!(radius >= 0.0)) throw std::invalid_argument("worst case: the radius must not be negative");
  const double budget = radius * radius;
  if (std::isinf(budget)) return 1.0;
  return transported_mass(distances.cwiseAbs2(), weights, budget);
}

double worst_case_probability(const DiscreteMeasure& measure, const UnsafeSet& unsafe,
                              double radius) {
  return worst_case_probability(
      clearances(measure.locations, unsafe).cwiseMax(0.0) / unsafe.lipschitz(), measure.weights,
      radius);
}

}  // namespace qsmpc::controller
