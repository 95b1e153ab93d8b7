#include "controller/planning/assignment_rounds.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Rounds of "optimise at frozen assignments, then predict with new ones" in one plan.
constexpr int kAssignmentRounds = 3;
// The same when the gains are optimised as well.
constexpr int kGainRounds = 2;
// Relative tolerance of the rounds on a warm start: the next period continues the optimisation.
constexpr double kWarmTolerance = 1e-7;
// On a warm start without constraints, the first round's tolerance is this share of the last
// change by new assignments, and at most the second number: what a round finds below that, the
// next assignments undo.
constexpr double kWarmShareOfChange = 0.1;
constexpr double kLoosestWarmTolerance = 1e-4;
// Relative tolerance of the first round of a cold start, as new assignments will change the
// problem; that of the following rounds is this share of the last change.
constexpr double kColdTolerance = 1e-5;
constexpr double kColdShareOfChange = 0.01;
// Relative decrease of the cost that a round must promise to be worth a prediction, for warm and
// cold starts.
constexpr double kWarmSettled = 1e-5;
constexpr double kColdSettled = 1e-6;
// The same with risk limits, where a new certificate shifts the limit by more than that.
constexpr double kLimitedSettled = 1e-4;
// Extra rounds if a particle violates a bound under new assignments, though none did under the old
// ones. Each tightens the bounds by the violation.
constexpr int kConstraintRounds = 5;
// Extra rounds if a plan's certificate exceeds a limit. A better plan that comes nearer to the
// limit by less than this share of what is missing, in log risk, ends them: no round would reach
// it.
constexpr int kRiskRounds = 3;
constexpr double kHopelessShare = 0.1;
// Most minimisations in one round until the multipliers have converged, and the tolerance of a
// limit, in log risk; the limits are tightened to make up for it.
constexpr int kMultiplierRounds = 6;
constexpr double kRiskTolerance = 0.02;
// Relative tolerance of these minimisations, as the multipliers change what is minimised.
constexpr double kMultiplierTolerance = 1e-5;
// Rounds that minimise the risk itself, and the weight of the cost beside it: the whole cost counts
// as this many units of log risk.
constexpr int kLeastRiskRounds = 2;
constexpr double kCostBesideRisk = 1e-3;

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

/// Sets up a search over the inputs of all stages and `entries` unbounded entries of the gains.
void AssignmentRounds::make_search(Eigen::Index entries, Search& out) {
  const Eigen::Index inputs = Eigen::Index{dynamics_.input_dim()} * settings_.horizon;
  out.problem.lower.setConstant(inputs + entries, -kInfinity);
  out.problem.upper.setConstant(inputs + entries, kInfinity);
  out.problem.lower.head(inputs) = settings_.bounds.lower.replicate(settings_.horizon, 1);
  out.problem.upper.head(inputs) = settings_.bounds.upper.replicate(settings_.horizon, 1);
  out.problem.cost = [this](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
    return evaluate(z, gradient);
  };
  out.solver = make_solver(settings_.solver, {.bounding = settings_.input_bounding});
  out.z.resize(inputs + entries);
}

double AssignmentRounds::evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
  const double cost =
      coarse_ != nullptr ? coarse_->evaluate(z, gradient) : evaluator_.cost().evaluate(z, gradient);
  if (aim_ == Aim::kCost) return cost;
  if (aim_ == Aim::kAugmented) return cost + lagrangian_.add(z, gradient);
  risk_gradient_.resize(z.size());
  const double risk = evaluator_.risk()->log_total(z, risk_gradient_);
  gradient = cost_share_ * gradient + risk_gradient_;
  return cost_share_ * cost + risk;
}

/// The cost that is being minimised, without constraints.
double AssignmentRounds::cost_of(const Eigen::VectorXd& z) {
  return coarse_ != nullptr ? coarse_->evaluate(z) : evaluator_.cost().evaluate(z);
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
  aim_ = Aim::kCost;
  if (RiskConstraint* const risk = evaluator_.risk()) {
    risk->set_margin(2.0 * kRiskTolerance);
    if (!solver_entry(settings_.solver).takes_constraints) {
      aim_ = Aim::kAugmented;
      if (plan.warm) lagrangian_.shift(risk->stage_rows());
      lagrangian_.start(*risk, evaluator_.evaluate_frozen(*plan.current), plan.warm);
    }
  }
  const int rounds = kAssignmentRounds + (plan.evaluated ? 0 : 1);
  tolerance_ = first_tolerance(plan);
  if (!plan.warm) change_ = 0.0;
  if (optimise(inputs_, rounds, plan) && gains_) {
    // The last prediction may be that of a rejected candidate.
    evaluator_.hold(*plan.current);
    (void)optimise(*gains_, kGainRounds, plan);
  }
  aim_ = Aim::kCost;
  if (plan.stopped()) return;
  if (plan.current->violation > kConstraintTolerance) {
    plan.status = SolverStatus::kInfeasible;
  } else if (plan.status == SolverStatus::kInfeasible) {
    // The failed search was for something better than the plan that is kept.
    plan.status = SolverStatus::kStalled;
  }
}

/// The lower limit of the solver's tolerance in the first round.
double AssignmentRounds::first_tolerance(const PlanInProgress& plan) const {
  // Constraints need precise rounds, and gains are optimised about converged inputs.
  if (evaluator_.constraints() || gains_) return 0.0;
  if (!plan.warm) return kColdTolerance;
  if (evaluator_.risk() != nullptr) return 0.0;
  return std::min(kLoosestWarmTolerance, kWarmShareOfChange * change_);
}

/// Whether the candidate violates something that another round, with tightened constraints, could
/// keep. Raises `rounds` up to its limit.
bool AssignmentRounds::asks_for_more(const Plan& candidate, PlanInProgress& plan, int round,
                                     int& rounds) const {
  const int usual = kAssignmentRounds + (plan.evaluated ? 0 : 1);
  if (candidate.violation > kConstraintTolerance && plan.status != SolverStatus::kInfeasible) {
    evaluator_.set_margin(evaluator_.margin() + candidate.violation);
    rounds = std::clamp(round + 2, rounds, std::max(rounds, usual + kConstraintRounds));
    return true;
  }
  RiskConstraint* const risk = evaluator_.risk();
  if (risk == nullptr || candidate.risk.kept || !(candidate.risk.severity > 0.0)) return false;
  // What no multiplier achieves is left to reduce_risk.
  if (aim_ == Aim::kAugmented && lagrangian_.exhausted()) return false;
  // The held surrogate is now the candidate's. The first shortfall was under another plan's
  // surrogate, so it does not count.
  if (round > 0) risk->set_margin(risk->margin() + std::clamp(candidate.risk.severity, 0.0, 0.5));
  rounds = std::clamp(round + 2, rounds, std::max(rounds, usual + kRiskRounds));
  return true;
}

/// The rounds of one search. Returns whether another search may follow.
bool AssignmentRounds::optimise(Search& search, int rounds, PlanInProgress& plan) {
  PlanStopwatch stopwatch;
  const auto may_go_on = [&] {
    return plan.evaluations < settings_.max_evaluations && !plan.stopped();
  };
  double last_severity = kInfinity;
  for (int n = 0; n < rounds && may_go_on(); ++n) {
    const bool promising = run_solver(search, plan);
    stopwatch.add_to(plan.timing.optimise);
    if (!promising) {
      if (tolerance_ == 0.0 || plan.warm) break;
      tolerance_ = 0.0;
      --n;  // no prediction was needed
      continue;
    }
    set_candidate(search.z, plan);
    const bool predicted = predict_candidate(plan);
    stopwatch.add_to(plan.timing.propagate);
    if (predicted) {
      change_ = std::abs(plan.candidate->cost.total() / search.least - 1.0);
      const double share = plan.warm ? kWarmShareOfChange : kColdShareOfChange;
      tolerance_ = std::min(tolerance_, share * change_);
    }
    const bool accepted = predicted && (!plan.evaluated || better(*plan.candidate, *plan.current));
    const bool more = asks_for_more(*plan.candidate, plan, n, rounds);
    const PlanRisk& risk = plan.candidate->risk;
    const bool hopeless =
        accepted && !risk.kept && last_severity - risk.severity < kHopelessShare * risk.severity;
    last_severity = risk.severity;
    if (accepted) plan.accept_candidate();
    if (plan.late()) plan.status = SolverStatus::kDeadline;
    if (hopeless || (!accepted && !more)) break;
  }
  if (!plan.evaluated) evaluator_.predict_and_evaluate(*plan.current);
  plan.evaluated = true;
  stopwatch.add_to(plan.timing.propagate);
  return may_go_on();
}

/// Sets the candidate's policy to that of the decision z.
void AssignmentRounds::set_candidate(const Eigen::VectorXd& z, PlanInProgress& plan) {
  const Eigen::MatrixXd& known = plan.current->policy.inputs;
  gain_change_ = plan.current->gain_change;
  if (z.size() > known.size()) {
    gain_change_ += z.tail(gain_change_.size()).reshaped(gain_change_.rows(), gain_change_.cols());
  }
  evaluator_.set_policy(z.head(known.size()).reshaped(known.rows(), known.cols()), gain_change_,
                        *plan.candidate);
}

/// Predicts the candidate unless its risk alone rules it out. Returns whether it did.
bool AssignmentRounds::predict_candidate(PlanInProgress& plan) {
  if (plan.evaluated) return evaluator_.predict_if_promising(*plan.candidate, *plan.current);
  evaluator_.predict_and_evaluate(*plan.candidate);
  return true;
}

SolverOptions AssignmentRounds::solver_options(const PlanInProgress& plan) const {
  SolverOptions options{.max_evaluations = settings_.max_evaluations - plan.evaluations,
                        .constraint_tolerance = kConstraintTolerance};
  if (plan.warm) options.relative_tolerance = kWarmTolerance;
  if (aim_ == Aim::kAugmented) options.relative_tolerance = kMultiplierTolerance;
  options.relative_tolerance = std::max(options.relative_tolerance, tolerance_);
  if (plan.deadline != PlanInProgress::Clock::time_point::max()) {
    // Leaves time for the prediction of the result.
    options.deadline = plan.deadline - std::chrono::duration_cast<PlanInProgress::Clock::duration>(
                                           evaluator_.prediction_time());
  }
  return options;
}

/// One run of the solver from search.z; with risk limits and a solver without constraints, repeated
/// until the multipliers have converged.
const SolverResult& AssignmentRounds::minimise(Search& search, PlanInProgress& plan) {
  const SolverResult* result =
      &search.solver->minimise(search.problem, search.z, solver_options(plan));
  plan.evaluations += result->evaluations;
  if (aim_ != Aim::kAugmented) return *result;
  for (int n = 1; n < kMultiplierRounds && std::isfinite(result->value); ++n) {
    if (!lagrangian_.update(result->z, kRiskTolerance)) break;
    if (plan.evaluations >= settings_.max_evaluations || plan.late()) break;
    search.z = result->z;
    result = &search.solver->minimise(search.problem, search.z, solver_options(plan));
    plan.evaluations += result->evaluations;
  }
  return *result;
}

/// Optimises at the held assignments, from the current plan; the result is in search.z. Returns
/// whether it is worth a prediction: finite, in time, and a more than negligible improvement.
bool AssignmentRounds::run_solver(Search& search, PlanInProgress& plan) {
  const Plan& current = *plan.current;
  search.z.setZero();
  search.z.head(current.policy.inputs.size()) = current.policy.inputs.reshaped();
  if (evaluator_.constraints()) search.problem.constraints = evaluator_.constraints();
  if (&search == &inputs_ && aim_ == Aim::kAugmented) coarse_ = evaluator_.coarse_about(current);
  const SolverResult& result = minimise(search, plan);
  plan.status = result.status;
  search.least = aim_ == Aim::kCost ? result.value : cost_of(result.z);
  coarse_ = nullptr;
  if (!std::isfinite(result.value)) {
    // If there was no time for a single evaluation, there is no value, and the plan stays as it is.
    plan.failed = plan.evaluated && result.status == SolverStatus::kNumericalTrouble;
    return false;
  }
  search.z = result.z;
  if (!plan.evaluated) return true;
  if (plan.late()) return false;
  if (!current.risk.kept && current.risk.severity > 0.0) return true;
  const double gain = current.cost.total() - search.least;
  const double unlimited = plan.warm ? kWarmSettled : kColdSettled;
  const double settled = evaluator_.risk() != nullptr ? kLimitedSettled : unlimited;
  return gain > settled * std::abs(current.cost.total()) ||
         current.violation > std::max(kConstraintTolerance, result.violation);
}

void AssignmentRounds::reduce_risk(PlanInProgress& plan) {
  if (plan.stopped()) return;
  PlanStopwatch stopwatch;
  aim_ = Aim::kRisk;
  for (int n = 0; n < kLeastRiskRounds && !plan.late(); ++n) {
    evaluator_.hold(*plan.current);
    const Plan& current = *plan.current;
    cost_share_ = kCostBesideRisk / std::max(std::abs(current.cost.total()), 1e-12);
    inputs_.solver->forget();
    inputs_.z = current.policy.inputs.reshaped();
    SolverOptions options = solver_options(plan);
    // The main optimisation may have used up its evaluations.
    options.max_evaluations = std::max(1, settings_.max_evaluations / 2);
    inputs_.problem.constraints.reset();
    if (solver_entry(settings_.solver).takes_constraints) {
      inputs_.problem.constraints = evaluator_.constraints();
    }
    coarse_ = evaluator_.coarse_about(current);
    const SolverResult& result = inputs_.solver->minimise(inputs_.problem, inputs_.z, options);
    coarse_ = nullptr;
    plan.evaluations += result.evaluations;
    stopwatch.add_to(plan.timing.optimise);
    if (!std::isfinite(result.value)) break;
    set_candidate(result.z, plan);
    const bool accepted = evaluator_.predict_if_better(*plan.candidate, *plan.current);
    stopwatch.add_to(plan.timing.propagate);
    if (accepted) plan.accept_candidate();
    if (!accepted || plan.current->risk.severity <= 0.0) break;
  }
  aim_ = Aim::kCost;
}

void AssignmentRounds::brake(PlanInProgress& plan) {
  PlanStopwatch stopwatch;
  aim_ = Aim::kCost;
  evaluator_.set_braking(true);
  evaluator_.hold(*plan.current);
  inputs_.solver->forget();
  inputs_.z = plan.current->policy.inputs.reshaped();
  inputs_.problem.constraints.reset();
  SolverOptions options = solver_options(plan);
  options.max_evaluations = settings_.max_evaluations;
  const SolverResult& result = inputs_.solver->minimise(inputs_.problem, inputs_.z, options);
  plan.evaluations += result.evaluations;
  stopwatch.add_to(plan.timing.optimise);
  evaluator_.set_braking(false);
  evaluator_.hold(*plan.current);
  if (!std::isfinite(result.value)) return;
  set_candidate(result.z, plan);
  evaluator_.predict_and_evaluate(*plan.candidate);
  plan.accept_candidate();
  stopwatch.add_to(plan.timing.propagate);
}

}  // namespace qsmpc::controller
