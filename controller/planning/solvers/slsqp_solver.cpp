#include "controller/planning/solvers/slsqp_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace qsmpc::controller {
namespace {

// Numbers of constraints that enter the working set at once, and that it may hold before some are
// dropped, both per decision: at a vertex, as many are active as there are decisions.
constexpr std::size_t kEnterPerDecision = 1;
constexpr std::size_t kHeldPerDecision = 3;
// NLopt starts with an identity Hessian. Decisions are scaled by the ranges of their bounds, and
// the cost so that the first step is this fraction of them.
constexpr double kSlsqpFirstMove = 0.2;
// How often a stalled run is restarted with half of its working set.
constexpr int kMostThinnings = 6;
// If NLopt stops short of feasibility without any new constraint, it is restarted as long as each
// run lowers the violation by this factor.
constexpr double kProgress = 0.5;

/// Feasible before infeasible, then lower cost or, if both are infeasible, lower violation.
bool better(double value, double violation, double than_value, double than_violation,
            double tolerance) {
  const bool kept = violation <= tolerance;
  const bool than_kept = than_violation <= tolerance;
  if (kept != than_kept) return kept;
  return kept ? value < than_value : violation < than_violation;
}

double largest_violation(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : std::max(values.maxCoeff(), 0.0);
}

}  // namespace

// Cost and working set at `z`; false if the run has to end.
bool SlsqpSolver::assess(const OcpProblem& problem, const Eigen::VectorXd& z, MeteredCost& cost) {
  Point& point = answer_.point;
  if (trouble_) return false;
  if (!answer_.evaluated || point.z != z) {
    answer_.evaluated = answer_.complete = false;
    if (!cost.evaluate(z, point.value, point.gradient)) return false;
    point.z = z;
    answer_.evaluated = true;
  }
  if (answer_.complete) return true;
  if (!working_.empty()) {
    problem.constraints->some(z, working_, answer_.constraints, answer_.constraint_gradients);
    trouble_ = !answer_.constraints.allFinite() || !answer_.constraint_gradients.allFinite();
    if (trouble_) return false;
  }
  point.violation = largest_violation(answer_.constraints);
  answer_.complete = true;
  if (better(point.value, point.violation, reached_.value, reached_.violation, tolerance_)) {
    reached_ = point;
  }
  return true;
}

// One run on the working set, from `reached_` to a new `reached_`.
NloptEnd SlsqpSolver::run(const OcpProblem& problem, const SolverOptions& options,
                          MeteredCost& cost) {
  const auto size = static_cast<Eigen::Index>(working_.size());
  const Eigen::VectorXd start = reached_.z.cwiseQuotient(scale_);
  answer_.constraints.resize(size);
  answer_.constraint_gradients.resize(start.size(), size);
  answer_.point = reached_;
  answer_.evaluated = true;
  answer_.complete = false;
  const double steepest = reached_.gradient.cwiseProduct(scale_).cwiseAbs().maxCoeff();
  const double factor = steepest > 0.0 ? kSlsqpFirstMove / steepest : 1.0;
  reached_.value = std::numeric_limits<double>::infinity();
  reached_.violation = std::numeric_limits<double>::infinity();
  NloptRun nlopt{.method = NloptMethod::kSlsqp,
                 .relative_tolerance = options.relative_tolerance,
                 .lower = problem.lower.cwiseQuotient(scale_),
                 .upper = problem.upper.cwiseQuotient(scale_),
                 .constraint_count = size,
                 .constraint_tolerance = tolerance_};
  const auto decisions = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return x.cwiseProduct(scale_).cwiseMax(problem.lower).cwiseMin(problem.upper);
  };
  nlopt.cost = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) -> std::optional<double> {
    if (!assess(problem, decisions(x), cost)) return std::nullopt;
    gradient = factor * answer_.point.gradient.cwiseProduct(scale_);
    return factor * answer_.point.value;
  };
  nlopt.constraints = [&](const Eigen::VectorXd& x, Eigen::VectorXd& values,
                          Eigen::MatrixXd& gradients) {
    if (!assess(problem, decisions(x), cost)) return false;
    values = answer_.constraints;
    gradients = scale_.asDiagonal() * answer_.constraint_gradients;
    return true;
  };
  return run_nlopt(nlopt, start);
}

// Evaluates all constraints at `point`, and sets its violation; false if one is not finite.
bool SlsqpSolver::check_all(const OcpProblem& problem, Point& point) {
  point.violation = 0.0;
  if (all_.size() > 0) {
    problem.constraints->values(point.z, all_);
    if (!all_.allFinite()) {
      trouble_ = true;
      return false;
    }
    point.violation = largest_violation(all_);
  }
  if (better(point.value, point.violation, best_.value, best_.violation, tolerance_)) {
    best_ = point;
  }
  return true;
}

// Adds the worst new constraint of each group above the threshold, the worst groups first.
std::size_t SlsqpSolver::enlarge(const OcpProblem& problem, double threshold) {
  const std::vector<int>& group = problem.constraints->group;
  const auto group_of = [&](int j) { return group.empty() ? j : group[j]; };
  const std::unordered_set<int> present(working_.begin(), working_.end());
  candidates_.clear();
  for (int j = 0; j < static_cast<int>(all_.size()); ++j) {
    if (all_[j] > threshold && !present.contains(j)) candidates_.push_back(j);
  }
  const auto worse = [&](int a, int b) { return all_[a] != all_[b] ? all_[a] > all_[b] : a < b; };
  std::sort(candidates_.begin(), candidates_.end(), worse);
  const std::size_t most = kEnterPerDecision * static_cast<std::size_t>(problem.lower.size());
  std::unordered_set<int> seen;
  std::size_t entered = 0;
  for (const int j : candidates_) {
    if (entered == most) break;
    if (!seen.insert(group_of(j)).second) continue;
    working_.push_back(j);
    ++entered;
  }
  return entered;
}

// Drops the constraints with most slack from a large working set. Any that are then violated will
// be added again.
void SlsqpSolver::drop_inactive() {
  const std::size_t most = kHeldPerDecision * static_cast<std::size_t>(best_.z.size());
  if (working_.size() <= most) return;
  std::sort(working_.begin(), working_.end(), [&](int a, int b) { return all_[a] > all_[b]; });
  while (working_.size() > most && all_[working_.back()] < -tolerance_) working_.pop_back();
}

// Evaluates the start, and adds the constraints nearest to it, however far away: one that does not
// matter only makes NLopt's steps a little slower.
bool SlsqpSolver::begin(const OcpProblem& problem, MeteredCost& cost) {
  if (!assess(problem, best_.z, cost) || !check_all(problem, reached_)) return false;
  if (all_.size() > 0) enlarge(problem, -std::numeric_limits<double>::infinity());
  return true;
}

SolverStatus SlsqpSolver::stopped_as(const MeteredCost& cost) const {
  return trouble_ ? SolverStatus::kNumericalTrouble
                  : cost.stopped().value_or(SolverStatus::kStalled);
}

// Keeps the worse half. NLopt stalls if gradients in the working set are nearly dependent, and
// often does not with fewer.
void SlsqpSolver::thin() {
  std::sort(working_.begin(), working_.end(), [&](int a, int b) { return all_[a] > all_[b]; });
  working_.resize(working_.size() / 2);
}

SolverStatus SlsqpSolver::rounds(const OcpProblem& problem, const SolverOptions& options,
                                 MeteredCost& cost) {
  double last_violation = std::numeric_limits<double>::infinity();
  int thinnings = 0;
  while (true) {
    const NloptEnd end = run(problem, options, cost);
    const double within_set = reached_.violation;
    if (!std::isfinite(reached_.value)) break;  // stopped before the first answer
    if (!check_all(problem, reached_)) break;
    if (end == NloptEnd::kStopped) break;
    const std::size_t entered = all_.size() > 0 ? enlarge(problem, tolerance_) : 0;
    const bool nearer = within_set > tolerance_ && within_set < kProgress * last_violation;
    const bool stuck = entered == 0 && !nearer;
    if (stuck && end == NloptEnd::kStalled && !working_.empty() && thinnings < kMostThinnings) {
      thin();
      ++thinnings;
      continue;
    }
    if (stuck) {
      return end == NloptEnd::kConverged ? SolverStatus::kConverged : SolverStatus::kStalled;
    }
    last_violation = entered > 0 ? std::numeric_limits<double>::infinity() : within_set;
    drop_inactive();
  }
  return stopped_as(cost);
}

const SolverResult& SlsqpSolver::minimise(const OcpProblem& problem, const Eigen::VectorXd& start,
                                          const SolverOptions& options) {
  check_problem(problem, start, options, ConstraintsTaken::kInequalities);
  const double infinity = std::numeric_limits<double>::infinity();
  tolerance_ = options.constraint_tolerance;
  trouble_ = false;
  working_.clear();
  all_.resize(problem.constraints ? problem.constraints->count : 0);
  answer_ = {};
  answer_.point.gradient.resize(start.size());
  scale_.resize(start.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const double range = problem.upper[i] - problem.lower[i];
    // A power of two, so that scaling is exact and an evaluated start is recognised.
    scale_[i] = std::isfinite(range) && range > 0.0 ? std::exp2(std::round(std::log2(range))) : 1.0;
  }
  best_ = {.z = start.cwiseMax(problem.lower).cwiseMin(problem.upper),
           .value = infinity,
           .violation = infinity,
           .gradient = {}};
  reached_ = best_;
  MeteredCost cost(problem, options);
  result_.status = begin(problem, cost) ? rounds(problem, options, cost) : stopped_as(cost);
  // Numerical trouble and the deadline take precedence; otherwise infeasibility overrides the
  // status.
  const bool cut = result_.status == SolverStatus::kNumericalTrouble ||
                   result_.status == SolverStatus::kDeadline;
  if (!cut && best_.violation > tolerance_) result_.status = SolverStatus::kInfeasible;
  result_.z = best_.z;
  result_.value = best_.value;
  result_.violation = all_.size() > 0 ? best_.violation : 0.0;
  result_.evaluations = cost.evaluations();
  return result_;
}

}  // namespace qsmpc::controller
