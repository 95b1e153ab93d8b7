#include "controller/planning/start/multi_start_search.hpp"

#include <algorithm>
#include <cmath>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {
// Fractions of the way from the middle of an input's bounds to their ends, for each half.
constexpr double kStartShares[] = {0.0, -0.9, -0.45, 0.45, 0.9};
// Number of groups whose best start descends, and the limits of a descent.
constexpr std::size_t kDescents = 6;
constexpr int kDescentEvaluations = 30;
constexpr double kDescentTolerance = 1e-5;
// Local minima that are returned, and the relative difference in cost that makes two distinct.
constexpr std::size_t kMostMinima = 3;
constexpr double kSameMinimum = 1e-3;

}  // namespace

MultiStartSearch::MultiStartSearch(const PlannerSettings& settings, NoiseFreeCost& cost)
    : cost_(cost), solver_(make_solver("lbfgs", {.bounding = "bounded"})) {
  const InputBounds& bounds = settings.bounds;
  const Eigen::VectorXd middle = 0.5 * (bounds.lower + bounds.upper);
  const Eigen::VectorXd reach = 0.5 * (bounds.upper - bounds.lower);
  const Eigen::Index dim = settings.cost.state.rows();
  const int horizon = settings.horizon;
  const int first = (horizon + 1) / 2;
  int group = 0;
  for (Eigen::Index input = 0; input < middle.size(); ++input) {
    for (const double early : kStartShares) {
      if (input > 0 && early == 0.0 && horizon == 1) continue;
      for (const double late : kStartShares) {
        // The start with all inputs in the middle already belongs to the first input.
        if (input > 0 && early == 0.0 && late == 0.0) continue;
        Eigen::MatrixXd inputs = middle.replicate(1, horizon);
        inputs.row(input).head(first).array() += early * reach[input];
        inputs.row(input).tail(horizon - first).array() += late * reach[input];
        candidates_.push_back(inputs);
        candidate_groups_.push_back(group);
      }
      ++group;
    }
  }
  starts_.resize(group);
  for (int n = 0; n < group; ++n) starts_[n].group = n;
  order_.reserve(starts_.size());
  minima_.reserve(kMostMinima);
  no_gain_change_.setZero(middle.size(), dim);
  problem_.lower = bounds.lower.replicate(horizon, 1);
  problem_.upper = bounds.upper.replicate(horizon, 1);
  problem_.cost = [this](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
    return cost_.evaluate(z, gradient);
  };
  z_.resize(problem_.lower.size());
}

const std::vector<const Eigen::MatrixXd*>& MultiStartSearch::search(
    PolicyMaker& policies, std::chrono::steady_clock::time_point deadline) {
  const auto late = [&] { return std::chrono::steady_clock::now() >= deadline; };
  for (Start& start : starts_) start.cost = kInfinity;
  for (std::size_t n = 0; n < candidates_.size(); ++n) {
    Start& start = starts_[candidate_groups_[n]];
    const double cost = cost_.evaluate(candidates_[n], no_gain_change_, policies);
    if (cost < start.cost || n == 0) {
      start.cost = cost;
      start.inputs = candidates_[n];
    }
    if (late()) break;
  }
  order_.clear();
  for (Start& start : starts_) {
    if (start.inputs.size() > 0 && (std::isfinite(start.cost) || order_.empty())) {
      order_.push_back(&start);
    }
  }
  const auto cheaper = [](const Start* a, const Start* b) {
    return a->cost != b->cost ? a->cost < b->cost : a->group < b->group;
  };
  std::sort(order_.begin(), order_.end(), cheaper);
  if (order_.size() > kDescents) order_.resize(kDescents);
  for (Start* const start : order_) {
    if (late()) break;
    descend(policies, *start);
  }
  std::sort(order_.begin(), order_.end(), cheaper);
  minima_.clear();
  double last = -kInfinity;
  for (const Start* const start : order_) {
    if (minima_.size() == kMostMinima) break;
    if (!minima_.empty() && start->cost - last <= kSameMinimum * std::abs(last)) continue;
    minima_.push_back(&start->inputs);
    last = start->cost;
  }
  return minima_;
}

void MultiStartSearch::descend(PolicyMaker& policies, Start& start) {
  cost_.freeze_assignments(start.inputs, no_gain_change_, policies);
  z_ = start.inputs.reshaped();
  solver_->forget();
  const SolverResult& result = solver_->minimise(
      problem_, z_,
      {.max_evaluations = kDescentEvaluations, .relative_tolerance = kDescentTolerance});
  if (!(result.value < start.cost)) return;
  start.inputs = result.z.reshaped(start.inputs.rows(), start.inputs.cols());
  // With the gains for the new inputs.
  start.cost = cost_.evaluate(start.inputs, no_gain_change_, policies);
}

}  // namespace qsmpc::controller
