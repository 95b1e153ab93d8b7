#include "controller/planning/solvers/projected_bfgs_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qsmpc::controller {
namespace {

// Without curvature, the largest entry of the first step is this fraction of its bounds' range.
constexpr double kFirstMove = 0.2;
// Fraction of the decrease predicted by the slope that a step must achieve (Armijo).
constexpr double kSufficient = 1e-4;
// Limits of the next trial, as fractions of the step last tried.
constexpr double kShortest = 0.1;
constexpr double kLongest = 0.5;
constexpr int kMostTrials = 12;
// Trials after which curvature from an earlier problem is discarded.
constexpr int kInheritedTrials = 2;
// Powell's damping: the least curvature along a step, relative to the model's.
constexpr double kLeastCurvature = 0.2;
// A step fits the model if at most this fraction of the slope along it remains at its end.
constexpr double kSlopeLeft = 0.5;
// Consecutive small decreases that end the search although the gradient is large, as at a kink.
constexpr int kSmallDecreases = 3;

/// Minimiser of the cubic with values 0 and `value` and slopes `slope` and `end_slope` at 0 and
/// `length`, or the middle if it has none in the allowed range.
double interpolated(double length, double slope, double value, double end_slope) {
  // Nocedal and Wright, Eq. 3.59.
  const double d1 = slope + end_slope - 3.0 * value / length;
  const double square = d1 * d1 - slope * end_slope;
  double best = kLongest * length;
  if (square >= 0.0) {
    const double d2 = std::sqrt(square);
    best = length * (1.0 - (end_slope + d2 - d1) / (end_slope - slope + 2.0 * d2));
  }
  if (!std::isfinite(best)) best = kLongest * length;
  return std::clamp(best, kShortest * length, kLongest * length);
}

}  // namespace

void ProjectedBfgsSolver::resize(Eigen::Index n) {
  if (z_.size() == n) return;
  known_ = Curvature::kNone;
  model_.resize(n);
  hessian_.resize(n, n);
  for (Eigen::VectorXd* vector : {&result_.z, &scale_, &z_, &gradient_, &below_, &above_, &step_,
                                  &trial_, &trial_gradient_, &moved_, &change_, &curved_}) {
    vector->resize(n);
  }
}

void ProjectedBfgsSolver::shift(const StageLayout& layout) {
  const Eigen::Index leading = layout.inputs_per_stage;
  const Eigen::Index staged = leading * layout.horizon;
  const Eigen::Index n = hessian_.rows();
  if (known_ == Curvature::kNone || leading < 1 || layout.horizon < 1 || staged > n) {
    forget();
    return;
  }
  // Entry i of the new vector is entry `before(i)` of the old one; reads stay ahead of writes.
  const Eigen::Index kept = staged - leading;
  const auto before = [&](Eigen::Index i) { return i < kept ? i + leading : i; };
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) hessian_(i, j) = hessian_(before(i), before(j));
  }
  // The last stage keeps its own curvature; its coupling with other entries is unknown and set to
  // zero. Block-diagonal with principal blocks of the old matrix, the new one stays positive
  // definite.
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = kept; j < staged; ++j) {
      if (i >= kept && i < staged) continue;
      hessian_(i, j) = 0.0;
      hessian_(j, i) = 0.0;
    }
  }
}

void ProjectedBfgsSolver::reset_curvature(const OcpProblem& problem) {
  known_ = Curvature::kInitial;
  double steepest = 0.0;  // largest entry of the scaled gradient that no bound blocks
  for (Eigen::Index i = 0; i < z_.size(); ++i) {
    const bool held = gradient_[i] > 0.0 ? z_[i] <= problem.lower[i] : z_[i] >= problem.upper[i];
    if (!held) steepest = std::max(steepest, std::abs(gradient_[i] * scale_[i]));
  }
  const double curvature = steepest > 0.0 ? steepest / kFirstMove : 1.0;
  hessian_.setZero();
  hessian_.diagonal() = curvature * scale_.array().square().inverse();
}

// First-order decrease if each entry moves as far as its bound or scale allows.
double ProjectedBfgsSolver::attainable(const OcpProblem& problem) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < z_.size(); ++i) {
    const double room = gradient_[i] > 0.0 ? z_[i] - problem.lower[i] : problem.upper[i] - z_[i];
    sum += std::abs(gradient_[i]) * std::min(room, scale_[i]);
  }
  return sum;
}

bool ProjectedBfgsSolver::find_step(const OcpProblem& problem) {
  below_ = problem.lower - z_;
  above_ = problem.upper - z_;
  if (model_.solve(hessian_, gradient_, below_, above_, step_)) return true;
  reset_curvature(problem);
  return model_.solve(hessian_, gradient_, below_, above_, step_);
}

// Backtracks until the cost falls enough; the full step is within the bounds.
ProjectedBfgsSolver::Search ProjectedBfgsSolver::search(const OcpProblem& problem,
                                                        const SolverOptions& options,
                                                        MeteredCost& cost) {
  const double slope = gradient_.dot(step_);
  if (!(slope < 0.0)) return Search::kFailed;
  const double least = 0.1 * options.relative_tolerance * std::abs(result_.value);
  const int trials = known_ == Curvature::kInherited ? kInheritedTrials : kMostTrials;
  double length = 1.0;
  for (int trial = 0; trial < trials; ++trial) {
    trial_ = (z_ + length * step_).cwiseMax(problem.lower).cwiseMin(problem.upper);
    double value = 0.0;
    if (!cost.evaluate(trial_, value, trial_gradient_)) return Search::kStopped;
    const double gain = value - result_.value;
    if (gain <= kSufficient * length * slope) {
      moved_ = trial_ - z_;
      change_ = trial_gradient_ - gradient_;
      fitting_ = trial == 0 && std::abs(trial_gradient_.dot(step_)) <= -kSlopeLeft * slope;
      z_.swap(trial_);
      gradient_.swap(trial_gradient_);
      result_.value = value;
      return Search::kDescended;
    }
    length = interpolated(length, slope, gain, trial_gradient_.dot(step_));
    if (-length * slope < least) break;
  }
  return Search::kFailed;
}

// BFGS with Powell's damping, which keeps B positive definite whatever the cost's curvature is.
void ProjectedBfgsSolver::learn() {
  double product = moved_.dot(change_);
  if (known_ == Curvature::kInitial && product > 0.0) {
    // The first pair of step and gradient change sets the scale (Nocedal and Wright, Eq. 6.20, for
    // B and in the metric of the ranges).
    const double curvature = change_.cwiseProduct(scale_).squaredNorm() / product;
    hessian_.diagonal() = curvature * scale_.array().square().inverse();
  }
  curved_.noalias() = hessian_ * moved_;
  double believed = moved_.dot(curved_);
  if (!(believed > 0.0)) return;
  if (known_ == Curvature::kInherited && product > 0.0 && product < kLeastCurvature * believed) {
    // The inherited curvature is far too large, as after a cost a thousand times larger: scale all
    // of it (Oren and Luenberger 1974).
    hessian_ *= product / believed;
    curved_ *= product / believed;
    believed = product;
  }
  known_ = Curvature::kLearnt;
  if (product < kLeastCurvature * believed) {
    const double share = (1.0 - kLeastCurvature) * believed / (believed - product);
    change_ = share * change_ + (1.0 - share) * curved_;
    product = moved_.dot(change_);
  }
  if (!(product > 0.0)) return;
  change_ /= std::sqrt(product);
  curved_ /= std::sqrt(believed);
  hessian_.noalias() += change_ * change_.transpose();
  hessian_.noalias() -= curved_ * curved_.transpose();
}

SolverStatus ProjectedBfgsSolver::run(const OcpProblem& problem, const SolverOptions& options,
                                      MeteredCost& cost) {
  if (known_ == Curvature::kNone) reset_curvature(problem);
  double decrease = std::numeric_limits<double>::infinity();
  int small_decreases = 0;
  while (true) {
    const double small = options.relative_tolerance * std::abs(result_.value);
    const double slope_small = std::sqrt(options.relative_tolerance) * std::abs(result_.value);
    const double within_reach = attainable(problem);
    if (within_reach == 0.0) return SolverStatus::kConverged;
    if (!find_step(problem)) return SolverStatus::kNumericalTrouble;
    // A small decrease alone is not convergence: either the slope must be small as well, or the
    // model, just found accurate, must predict no larger decrease.
    small_decreases = decrease <= small ? small_decreases + 1 : 0;
    const bool flat = within_reach <= slope_small || (fitting_ && -model_.value() <= small);
    if (small_decreases > 0 && flat) return SolverStatus::kConverged;
    if (small_decreases >= kSmallDecreases) return SolverStatus::kStalled;
    const double before = result_.value;
    const Search outcome = search(problem, options, cost);
    if (outcome == Search::kStopped) return *cost.stopped();
    if (outcome == Search::kFailed) {
      if (known_ == Curvature::kInitial) {
        return flat ? SolverStatus::kConverged : SolverStatus::kStalled;
      }
      reset_curvature(problem);
      continue;
    }
    decrease = before - result_.value;
    learn();
  }
}

const SolverResult& ProjectedBfgsSolver::minimise(const OcpProblem& problem,
                                                  const Eigen::VectorXd& start,
                                                  const SolverOptions& options) {
  check_problem(problem, start, options, ConstraintsTaken::kNone);
  resize(start.size());
  if (known_ != Curvature::kNone) known_ = Curvature::kInherited;
  z_ = start.cwiseMax(problem.lower).cwiseMin(problem.upper);
  for (Eigen::Index i = 0; i < z_.size(); ++i) {
    const double range = problem.upper[i] - problem.lower[i];
    scale_[i] = std::isfinite(range) && range > 0.0 ? range : 1.0;
  }
  result_.value = std::numeric_limits<double>::infinity();
  result_.violation = 0.0;
  MeteredCost cost(problem, options);
  double value = 0.0;
  if (cost.evaluate(z_, value, gradient_)) {
    result_.value = value;
    result_.status = run(problem, options, cost);
  } else {
    result_.status = *cost.stopped();
  }
  result_.z = z_;
  result_.evaluations = cost.evaluations();
  return result_;
}

}  // namespace qsmpc::controller
