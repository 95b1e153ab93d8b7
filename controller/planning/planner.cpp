#include "controller/planning/planner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace qsmpc::controller {
namespace {

using Clock = PlanInProgress::Clock;

// Builds the message only on failure, so that planning allocates nothing.
void require_plannable(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("planner: ") + message);
}

PlannerSettings checked(PlannerSettings settings, const models::Dynamics& dynamics) {
  check_planner_settings(settings, dynamics.state_dim(), dynamics.input_dim());
  return settings;
}

}  // namespace

Planner::Planner(const models::Dynamics& dynamics, PlannerSettings settings)
    : dynamics_(dynamics),
      settings_(checked(std::move(settings), dynamics)),
      evaluator_(dynamics_, settings_),
      start_(dynamics_, settings_, evaluator_),
      rounds_(dynamics_, settings_, evaluator_),
      effort_(settings_, evaluator_) {
  require_plannable(settings_.otherwise != RiskOtherwise::kBrake || !speeds_of(dynamics_).empty(),
                    "a system without a speed among its states cannot brake");
  if (settings_.otherwise == RiskOtherwise::kModel && settings_.model_error) {
    PlannerSettings errorless = settings_;
    errorless.model_error.reset();
    errorless.otherwise = RiskOtherwise::kLeastRisk;
    errorless_ = std::make_unique<Planner>(dynamics_, std::move(errorless));
  }
}

void Planner::set_limits(const PlanRequest& request) {
  const RiskLimits& limits = settings_.risk;
  evaluator_.set_limits({.first = std::min(limits.first, request.limits.first),
                         .stage = std::min(limits.stage, request.limits.stage),
                         .plan = std::min(limits.plan, request.limits.plan)},
                        request.period);
}

/// A plan of which only the belief is set.
PlanInProgress Planner::begin(const Gaussian& belief, const PlanRequest& request) {
  PlanInProgress plan{.deadline = request.deadline};
  if (std::isfinite(settings_.deadline)) {
    const auto longest = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(settings_.deadline));
    plan.deadline = std::min(request.deadline, Clock::now() + longest);
  }
  std::array<Plan*, 2> spare{};
  for (std::size_t n = 0, to = 0; n < plans_.size() && to < spare.size(); ++n) {
    if (&plans_[n] != last_) spare[to++] = &plans_[n];
  }
  plan.current = spare[0];
  plan.candidate = spare[1];
  PlanStopwatch stopwatch;
  set_limits(request);
  evaluator_.take_belief(belief, request.progress);
  stopwatch.add_to(plan.timing.quantise);
  return plan;
}

const Plan& Planner::plan(const Gaussian& belief, const PlanRequest& request) {
  PlanInProgress plan = begin(belief, request);
  PlanStopwatch stopwatch;
  start_.choose(belief, failed_ ? nullptr : last_, plan);
  if (!plan.warm && !plan.late() && begin_effort(*plan.current)) {
    evaluator_.set_policy(plan.current->policy.inputs, plan.current->gain_change, *plan.current);
    evaluator_.predict_and_evaluate(*plan.current);
    plan.evaluated = true;
  }
  stopwatch.add_to(plan.timing.propagate);
  return finish(plan, belief, request);
}

const Plan& Planner::plan_from(const Gaussian& belief, const Plan& start,
                               std::optional<double> progress) {
  reset();
  const PlanRequest request{.progress = progress};
  PlanInProgress plan = begin(belief, request);
  PlanStopwatch stopwatch;
  plan.current->policy = start.policy;
  plan.current->gain_change = start.gain_change;
  // Holds the assignments of the start, of which the cost is not asked for: as on a warm start.
  evaluator_.predict_and_evaluate(*plan.current);
  stopwatch.add_to(plan.timing.propagate);
  return finish(plan, belief, request);
}

/// Optimises the plan, with what its risk limits ask for, and keeps it as the last one.
const Plan& Planner::finish(PlanInProgress& plan, const Gaussian& belief,
                            const PlanRequest& request) {
  rounds_.optimise(plan);
  if (evaluator_.risk() != nullptr) settle(plan, belief, request);
  Plan& made = *plan.current;
  made.fallback = (plan.failed || !std::isfinite(made.cost.total())) && last_ != nullptr;
  if (made.fallback) fall_back(made);
  // Also sets the belief of plans not used yet, so that no later period has to allocate.
  for (Plan& room : plans_) {
    if (&room == &made || room.belief.measure.size() == 0) room.belief = evaluator_.belief();
  }
  made.status = plan.status;
  made.evaluations = plan.evaluations;
  made.warm = plan.warm;
  made.timing = plan.timing;
  failed_ = made.fallback || plan.status == SolverStatus::kNumericalTrouble;
  last_ = &made;
  return made;
}

/// If a risk limit is exceeded: searches once more for a plan within it and, failing that, applies
/// the fallback of the settings. Then records the inputs to continue from.
void Planner::settle(PlanInProgress& plan, const Gaussian& belief, const PlanRequest& request) {
  if (kept_inputs_.size() > 0) shift_inputs(Eigen::MatrixXd(kept_inputs_), kept_inputs_);
  const bool usable = !plan.failed && std::isfinite(plan.current->cost.total());
  if (usable && !plan.late()) evaluator_.accept_risk(*plan.current);
  if (usable && !plan.current->risk.kept && !plan.late()) {
    if (kept_inputs_.size() > 0) try_tail(plan, false);
    if (!plan.current->risk.kept) choose_effort(plan);
    evaluator_.accept_risk(*plan.current);
    if (!plan.current->risk.kept && plan.current->risk.severity > 0.0 && !errorless_) {
      rounds_.reduce_risk(plan);
    }
    const bool exceeded = !plan.current->risk.kept;
    if (exceeded && settings_.otherwise == RiskOtherwise::kPrevious && kept_inputs_.size() > 0) {
      try_tail(plan, true);
    }
    if (exceeded && settings_.otherwise == RiskOtherwise::kBrake) rounds_.brake(plan);
  }
  if (errorless_) plan_without_error(plan, belief, request);
  if (usable && !plan.late()) evaluator_.accept_risk(*plan.current);
  if (!plan.current->risk.kept) {
    if (!plan.stopped()) plan.status = SolverStatus::kRiskExceeded;
  } else {
    kept_inputs_ = plan.current->policy.inputs;
    // For the next period; this plan keeps its certified gains.
    if (usable && !plan.late()) (void)effort_.follow(*plan.current);
  }
}

/// Chooses the effort of the gains on a cold start: for the first plan, from the whole ladder; for
/// a later one, which goes another way under the same weights and noise, among the neighbours.
/// Returns whether it changed.
bool Planner::begin_effort(const Plan& plan) {
  return last_ == nullptr ? effort_.search(plan) : effort_.search_nearby(plan);
}

/// Gives the current plan the gains for which its inputs have a lower certificate.
void Planner::choose_effort(PlanInProgress& plan) {
  PlanStopwatch stopwatch;
  if (effort_.follow(*plan.current)) {
    const Plan& current = *plan.current;
    evaluator_.set_policy(current.policy.inputs, current.gain_change, *plan.candidate);
    if (evaluator_.predict_if_better(*plan.candidate, *plan.current)) plan.accept_candidate();
  }
  stopwatch.add_to(plan.timing.propagate);
}

/// Replaces the current plan by the tail of the last one within its limits, if that is better or in
/// any case.
void Planner::try_tail(PlanInProgress& plan, bool in_any_case) {
  PlanStopwatch stopwatch;
  evaluator_.set_policy(kept_inputs_, plan.current->gain_change, *plan.candidate);
  if (in_any_case) {
    evaluator_.predict_and_evaluate(*plan.candidate);
    plan.accept_candidate();
  } else if (evaluator_.predict_if_better(*plan.candidate, *plan.current)) {
    plan.accept_candidate();
  }
  stopwatch.add_to(plan.timing.propagate);
}

/// If a limit is exceeded, replaces the current plan by that for the model without its error,
/// certified with the error.
void Planner::plan_without_error(PlanInProgress& plan, const Gaussian& belief,
                                 const PlanRequest& request) {
  const bool wanted = !plan.failed && !plan.current->risk.kept && !plan.late();
  if (wanted) {
    if (!errorless_goes_on_) errorless_->reset();
    PlanRequest same = request;
    same.deadline = plan.deadline;
    const Plan& other = errorless_->plan(belief, same);
    if (std::isfinite(other.cost.total())) {
      PlanStopwatch stopwatch;
      plan.candidate->policy = other.policy;
      plan.candidate->gain_change = other.gain_change;
      evaluator_.predict_and_evaluate(*plan.candidate);
      plan.accept_candidate();
      plan.evaluations += other.evaluations;
      stopwatch.add_to(plan.timing.propagate);
    }
  }
  errorless_goes_on_ = wanted;
}

/// Continues the previous plan after a failure.
void Planner::fall_back(Plan& plan) {
  Eigen::MatrixXd inputs;
  shift_inputs(last_->policy.inputs, inputs);
  evaluator_.set_policy(inputs, last_->gain_change, plan);
  evaluator_.predict_and_evaluate(plan);
}

const Plan& Planner::prescribe(const Gaussian& belief,
                               const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  const InputBounds& bounds = settings_.bounds;
  require_plannable(inputs.rows() == dynamics_.input_dim() && inputs.cols() == settings_.horizon,
                    "the inputs must be a matrix of inputs x stages");
  // Comparisons with NaN are false, so NaN is rejected as well.
  require_plannable(((inputs.colwise() - bounds.lower).array() >= 0.0).all() &&
                        ((inputs.colwise() - bounds.upper).array() <= 0.0).all(),
                    "the inputs must be within their bounds");
  begin_prescribed(belief, {});
  PlanStopwatch stopwatch;
  evaluator_.set_policy(inputs, Eigen::MatrixXd::Zero(dynamics_.input_dim(), dynamics_.state_dim()),
                        prescribed_);
  evaluator_.predict_and_evaluate(prescribed_);
  stopwatch.add_to(prescribed_.timing.propagate);
  return prescribed_;
}

/// Starts a prescribed plan, of which only the belief is set.
void Planner::begin_prescribed(const Gaussian& belief, std::optional<double> progress) {
  PlanStopwatch stopwatch;
  prescribed_ = {};
  evaluator_.take_belief(belief, progress);
  prescribed_.belief = evaluator_.belief();
  stopwatch.add_to(prescribed_.timing.quantise);
}

const Plan& Planner::price(const Gaussian& belief, const Plan& plan,
                           std::optional<double> progress) {
  begin_prescribed(belief, progress);
  PlanStopwatch stopwatch;
  prescribed_.policy = plan.policy;
  prescribed_.gain_change = plan.gain_change;
  evaluator_.predict_and_evaluate(prescribed_);
  if (evaluator_.risk() != nullptr) evaluator_.accept_risk(prescribed_);
  stopwatch.add_to(prescribed_.timing.propagate);
  return prescribed_;
}

void Planner::prepare(const Eigen::MatrixXd& covariance) {
  GaussianQuantisation unused;
  evaluator_.quantiser().quantise(
      {.mean = Eigen::VectorXd::Zero(dynamics_.state_dim()), .covariance = covariance}, unused);
}

std::optional<double> Planner::way_to_target(const Eigen::VectorXd& state,
                                             std::optional<double> progress) {
  if (settings_.path && progress) return std::max(0.0, settings_.path->end - *progress);
  if (settings_.waypoints) {
    return way_over(*settings_.waypoints, dynamics_.description(), state, progress.value_or(0.0));
  }
  std::optional<Guide>& guide = evaluator_.guide();
  if (!guide) return std::nullopt;
  return guide->aim(state).way;
}

PredictedMotion motion_of(const Planner& planner, const Gaussian& belief, const Plan& plan) {
  return {.dynamics = planner.dynamics(),
          .noise_covariance = planner.settings().noise_covariance,
          .noise_w2 = planner.propagator().noise_w2(),
          .belief = belief,
          .belief_w2 = plan.belief.w2,
          .policy = plan.policy,
          .prediction = plan.prediction};
}

}  // namespace qsmpc::controller
