#include "controller/planning/solvers/lbfgs_solver.hpp"

#include <algorithm>
#include <cmath>

#include "controller/planning/solvers/nlopt_run.hpp"

namespace qsmpc::controller {
namespace {

// An excess of a tenth of the range costs as much as the start; one of a hundredth costs 1 % of it.
constexpr double kPenaltyWeight = 100.0;

bool within(const Eigen::VectorXd& z, const OcpProblem& problem) {
  return (z.array() >= problem.lower.array()).all() && (z.array() <= problem.upper.array()).all();
}

SolverStatus status_of(NloptEnd end) {
  return end == NloptEnd::kConverged ? SolverStatus::kConverged : SolverStatus::kStalled;
}

}  // namespace

void LbfgsSolver::keep(const Eigen::VectorXd& z, double value) {
  if (!(value < result_.value)) return;
  result_.value = value;
  result_.z = z;
}

void LbfgsSolver::run(const OcpProblem& problem, const SolverOptions& options, MeteredCost& cost,
                      Trial& trial) {
  const BoundedInputs bounded(bounding_, problem.lower, problem.upper);
  const bool penalised = bounding_ == InputBounding::kPenalty;
  // The last evaluation is reserved for the cost of the clamped result.
  const int limit = std::max(1, options.max_evaluations - (penalised ? 1 : 0));
  bool exhausted = false;
  double weight = 0.0;
  Eigen::VectorXd z(result_.z.size());
  NloptRun nlopt{.method = NloptMethod::kLbfgs, .relative_tolerance = options.relative_tolerance};
  nlopt.cost = [&](const Eigen::VectorXd& theta,
                   Eigen::VectorXd& gradient) -> std::optional<double> {
    bounded.inputs(theta, z);
    double value = 0.0;
    exhausted = cost.evaluations() >= limit;
    if (exhausted || !cost.evaluate(z, value, gradient)) return std::nullopt;
    if (!penalised || within(z, problem)) keep(z, value);
    if (cost.evaluations() == 1) {
      weight = kPenaltyWeight * (value == 0.0 ? 1.0 : std::abs(value));
    }
    if (penalised) value += weight * bounded.excess(z, weight, gradient);
    if (value < trial.value) trial = {.z = z, .value = value};
    bounded.pull_back(theta, gradient);
    return value;
  };
  const NloptEnd end = run_nlopt(nlopt, bounded.theta(result_.z));
  result_.status =
      exhausted ? SolverStatus::kIterationLimit : cost.stopped().value_or(status_of(end));
}

const SolverResult& LbfgsSolver::minimise(const OcpProblem& problem, const Eigen::VectorXd& start,
                                          const SolverOptions& options) {
  check_problem(problem, start, options, ConstraintsTaken::kNone);
  result_ = {.z = start.cwiseMax(problem.lower).cwiseMin(problem.upper),
             .value = std::numeric_limits<double>::infinity()};
  MeteredCost cost(problem, options);
  Trial trial;
  run(problem, options, cost, trial);
  const bool beyond = trial.z.size() > 0 && !within(trial.z, problem);
  if (beyond && !cost.stopped()) {
    trial.z = trial.z.cwiseMax(problem.lower).cwiseMin(problem.upper).eval();
    Eigen::VectorXd gradient(trial.z.size());
    if (cost.evaluate(trial.z, trial.value, gradient)) keep(trial.z, trial.value);
    if (cost.stopped()) result_.status = *cost.stopped();
  }
  result_.evaluations = cost.evaluations();
  return result_;
}

}  // namespace qsmpc::controller
