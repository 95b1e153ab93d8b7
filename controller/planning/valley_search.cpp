#include "controller/planning/valley_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace qsmpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Shares of the way from the middle of an input's bounds to their ends, for each half.
constexpr double kShares[] = {0.0, -0.9, -0.45, 0.45, 0.9};
// Groups whose best start descends, and how far.
constexpr std::size_t kDescents = 6;
constexpr int kDescentEvaluations = 30;
constexpr double kDescentTolerance = 1e-5;
// Valleys that are returned, and the relative difference in cost that makes two of them different.
constexpr std::size_t kValleys = 3;
constexpr double kSameValley = 1e-3;

double or_infinity(double cost) { return std::isnan(cost) ? kInfinity : cost; }

}  // namespace

ValleySearch::ValleySearch(const PlannerSettings& settings, const HorizonCostTerms& terms)
    : cost_(terms), solver_(make_solver("lbfgs", {.bounding = "bounded"})) {
  const InputBounds& bounds = settings.bounds;
  const Eigen::VectorXd middle = 0.5 * (bounds.lower + bounds.upper);
  const Eigen::VectorXd reach = 0.5 * (bounds.upper - bounds.lower);
  const Eigen::Index dim = terms.cost.state.rows();
  const int horizon = settings.horizon;
  const int first = (horizon + 1) / 2;
  int group = 0;
  for (Eigen::Index input = 0; input < middle.size(); ++input) {
    for (const double early : kShares) {
      if (input > 0 && early == 0.0 && horizon == 1) continue;
      for (const double late : kShares) {
        // All inputs in the middle are a start of the first input's.
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
  valleys_.reserve(kValleys);
  no_gain_change_.setZero(middle.size(), dim);
  problem_.lower = bounds.lower.replicate(horizon, 1);
  problem_.upper = bounds.upper.replicate(horizon, 1);
  problem_.cost = [this](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
    return cost_.evaluate(z, gradient);
  };
  z_.resize(problem_.lower.size());
  const Eigen::Index points = 2 * dim;
  noise_free_.stages.resize(horizon + 1);
  for (DiscreteMeasure& stage : noise_free_.stages) {
    stage.locations.resize(dim, points);
    stage.weights.setConstant(points, 1.0 / static_cast<double>(points));
  }
  noise_free_.maps.resize(horizon);
  for (StageMap& map : noise_free_.maps) {
    map.identity = true;
    map.weights = noise_free_.stages[0].weights;
  }
}

const std::vector<const Eigen::MatrixXd*>& ValleySearch::search(
    const Gaussian& belief, PolicyMaker& policies, std::chrono::steady_clock::time_point deadline) {
  const auto late = [&] { return std::chrono::steady_clock::now() >= deadline; };
  place_points(belief);
  for (Start& start : starts_) start.cost = kInfinity;
  for (std::size_t n = 0; n < candidates_.size(); ++n) {
    Start& start = starts_[candidate_groups_[n]];
    hold(belief.mean, candidates_[n], policies);
    const double cost = or_infinity(cost_.price(z_));
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
    descend(belief.mean, policies, *start);
  }
  std::sort(order_.begin(), order_.end(), cheaper);
  valleys_.clear();
  double last = -kInfinity;
  for (const Start* const start : order_) {
    if (valleys_.size() == kValleys) break;
    if (!valleys_.empty() && start->cost - last <= kSameValley * std::abs(last)) continue;
    valleys_.push_back(&start->inputs);
    last = start->cost;
  }
  return valleys_;
}

/// ±√d σ_i e_i about the mean, for the eigenvectors e_i of the covariance.
void ValleySearch::place_points(const Gaussian& belief) {
  const Eigen::Index dim = belief.mean.size();
  if (covariance_.size() == 0 || covariance_ != belief.covariance) {
    covariance_ = belief.covariance;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance_);
    const Eigen::VectorXd reach =
        (static_cast<double>(dim) * eigen.eigenvalues().cwiseMax(0.0)).cwiseSqrt();
    offsets_.resize(dim, 2 * dim);
    offsets_.leftCols(dim) = eigen.eigenvectors() * reach.asDiagonal();
    offsets_.rightCols(dim) = -offsets_.leftCols(dim);
  }
  noise_free_.stages[0].locations = offsets_.colwise() + belief.mean;
}

/// Makes the cost that of the policy with these inputs, which are left in `z_`.
void ValleySearch::hold(const Eigen::VectorXd& mean, const Eigen::MatrixXd& inputs,
                        PolicyMaker& policies) {
  policies.make(mean, inputs, no_gain_change_, policy_);
  cost_.hold(noise_free_, policy_);
  z_ = inputs.reshaped();
}

void ValleySearch::descend(const Eigen::VectorXd& mean, PolicyMaker& policies, Start& start) {
  hold(mean, start.inputs, policies);
  solver_->forget();
  const SolverResult& result = solver_->minimise(
      problem_, z_,
      {.max_evaluations = kDescentEvaluations, .relative_tolerance = kDescentTolerance});
  if (!(result.value < start.cost)) return;
  start.inputs = result.z.reshaped(start.inputs.rows(), start.inputs.cols());
  // With the gains that belong to them.
  hold(mean, start.inputs, policies);
  start.cost = or_infinity(cost_.price(z_));
}

}  // namespace qsmpc
