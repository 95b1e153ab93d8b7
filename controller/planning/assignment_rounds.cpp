#include "controller/planning/assignment_rounds.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Rounds of "optimise at frozen assignments, then predict with new ones" in one plan.
constexpr int kAssignmentRounds = 3;
// The same with the gains among what is optimised.
constexpr int kGainRounds = 2;
// On a warm start the rounds need not be more precise than this, relatively: the next period goes
// on.
constexpr double kWarmTolerance = 1e-7;
// The first round of a cold start need be no more precise than this, relatively, as new assignments
// will change the problem, and the following ones than this share of the last change.
constexpr double kColdTolerance = 1e-5;
constexpr double kShareOfChange = 0.01;
// What a round must promise of the cost, relatively, to be worth a prediction, warm or cold.
constexpr double kWarmSettled = 1e-5;
constexpr double kColdSettled = 1e-6;
// Further rounds where a particle is beyond a bound with new assignments, though none was with the
// old ones. Each asks for as much more room as was lacking.
constexpr int kConstraintRounds = 5;

}  // namespace

AssignmentRounds::AssignmentRounds(const models::Dynamics& dynamics,
                                   const PlannerSettings& settings, PlanEvaluator& evaluator)
    : dynamics_(dynamics),
      settings_(settings),
      evaluator_(evaluator),
      gain_change_(Eigen::MatrixXd::Zero(dynamics.input_dim(), dynamics.state_dim())) {
  make_search(0, inputs_);
  if (settings_.closed_loop && settings_.optimise_gain) {
    gains_ = std::make_unique<Search>();
    make_search(gain_change_.size(), *gains_);
  }
}

/// Over the inputs of all stages and `entries` entries of the gains, which are not bounded.
void AssignmentRounds::make_search(Eigen::Index entries, Search& out) {
  const Eigen::Index inputs = Eigen::Index{dynamics_.input_dim()} * settings_.horizon;
  out.problem.lower.setConstant(inputs + entries, -kInfinity);
  out.problem.upper.setConstant(inputs + entries, kInfinity);
  out.problem.lower.head(inputs) = settings_.bounds.lower.replicate(settings_.horizon, 1);
  out.problem.upper.head(inputs) = settings_.bounds.upper.replicate(settings_.horizon, 1);
  HorizonCost& cost = evaluator_.cost();
  out.problem.cost = [&cost](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
    return cost.evaluate(z, gradient);
  };
  out.solver = make_solver(settings_.solver, {.bounding = settings_.input_bounding});
  out.z.resize(inputs + entries);
}

void AssignmentRounds::start(OcpSolver& solver, bool warm) const {
  if (warm) {
    solver.shift({.inputs_per_stage = dynamics_.input_dim(), .horizon = settings_.horizon});
  } else {
    solver.forget();
  }
}

void AssignmentRounds::optimise(PlanInProgress& plan) {
  start(*inputs_.solver, plan.warm);
  if (gains_) start(*gains_->solver, plan.warm);
  evaluator_.set_margin(0.0);
  const int rounds = kAssignmentRounds + (plan.evaluated ? 0 : 1);
  // Constraints are met by rounds that are precise, or else by none; and gains are searched for
  // about inputs that have converged.
  const bool loose = !plan.warm && !evaluator_.constraints() && !gains_;
  tolerance_ = loose ? kColdTolerance : 0.0;
  if (optimise(inputs_, rounds, plan) && gains_) {
    // What was predicted last may be a candidate that was refused.
    evaluator_.freeze_assignments(plan.current->prediction, plan.current->policy);
    (void)optimise(*gains_, kGainRounds, plan);
  }
  if (plan.stopped()) return;
  if (plan.current->violation > kConstraintTolerance) {
    plan.status = SolverStatus::kInfeasible;
  } else if (plan.status == SolverStatus::kInfeasible) {
    // Of a search for something better than the plan that is kept.
    plan.status = SolverStatus::kStalled;
  }
}

/// Rounds of one search. Returns whether another one may follow.
bool AssignmentRounds::optimise(Search& search, int rounds, PlanInProgress& plan) {
  PlanStopwatch stopwatch;
  const int most_rounds = rounds + kConstraintRounds;
  const auto may_go_on = [&] {
    return plan.evaluations < settings_.max_evaluations && !plan.stopped();
  };
  for (int n = 0; n < rounds && may_go_on(); ++n) {
    const bool promising = run_solver(search, plan);
    stopwatch.add_to(plan.timing.optimise);
    if (!promising) {
      if (tolerance_ == 0.0) break;
      tolerance_ = 0.0;
      --n;  // no prediction was needed
      continue;
    }
    predict_candidate(search.z, plan);
    stopwatch.add_to(plan.timing.propagate);
    if (tolerance_ > 0.0) {
      const double change = std::abs(plan.candidate->cost.total() / search.least - 1.0);
      tolerance_ = std::min(tolerance_, kShareOfChange * change);
    }
    const double excess = plan.candidate->violation;
    const bool accepted = !plan.evaluated || better(*plan.candidate, *plan.current);
    if (accepted) plan.accept_candidate();
    if (plan.late()) plan.status = SolverStatus::kDeadline;
    if (excess > kConstraintTolerance && plan.status != SolverStatus::kInfeasible) {
      evaluator_.set_margin(evaluator_.margin() + excess);
      rounds = std::clamp(n + 2, rounds, most_rounds);
    } else if (!accepted) {
      break;
    }
  }
  if (!plan.evaluated) evaluator_.predict_and_evaluate(*plan.current);
  plan.evaluated = true;
  stopwatch.add_to(plan.timing.propagate);
  return may_go_on();
}

/// Makes the candidate the plan of the decision z.
void AssignmentRounds::predict_candidate(const Eigen::VectorXd& z, PlanInProgress& plan) {
  const Eigen::MatrixXd& known = plan.current->policy.inputs;
  gain_change_ = plan.current->gain_change;
  if (z.size() > known.size()) {
    gain_change_ += z.tail(gain_change_.size()).reshaped(gain_change_.rows(), gain_change_.cols());
  }
  evaluator_.set_policy(z.head(known.size()).reshaped(known.rows(), known.cols()), gain_change_,
                        *plan.candidate);
  evaluator_.predict_and_evaluate(*plan.candidate);
}

/// Optimises at the assignments that are held, from the current plan; the result is in search.z.
/// Returns whether it is worth a prediction: finite, better by more than nothing, and in time.
bool AssignmentRounds::run_solver(Search& search, PlanInProgress& plan) {
  const Plan& current = *plan.current;
  search.z.setZero();
  search.z.head(current.policy.inputs.size()) = current.policy.inputs.reshaped();
  if (evaluator_.constraints()) search.problem.constraints = evaluator_.constraints();
  SolverOptions options{.max_evaluations = settings_.max_evaluations - plan.evaluations,
                        .constraint_tolerance = kConstraintTolerance};
  if (plan.warm) options.relative_tolerance = kWarmTolerance;
  options.relative_tolerance = std::max(options.relative_tolerance, tolerance_);
  if (plan.deadline != PlanInProgress::Clock::time_point::max()) {
    // Time for the prediction that belongs to the result.
    options.deadline = plan.deadline - std::chrono::duration_cast<PlanInProgress::Clock::duration>(
                                           evaluator_.prediction_time());
  }
  const SolverResult& result = search.solver->minimise(search.problem, search.z, options);
  plan.evaluations += result.evaluations;
  plan.status = result.status;
  search.least = result.value;
  if (!std::isfinite(result.value)) {
    // Without time for a single evaluation there is no value, and the plan stands as it is.
    plan.failed = plan.evaluated && result.status == SolverStatus::kNumericalTrouble;
    return false;
  }
  search.z = result.z;
  if (!plan.evaluated) return true;
  if (plan.late()) return false;
  const double gain = current.cost.total() - result.value;
  const double settled = plan.warm ? kWarmSettled : kColdSettled;
  return gain > settled * std::abs(current.cost.total()) ||
         current.violation > std::max(kConstraintTolerance, result.violation);
}

}  // namespace qsmpc::controller
