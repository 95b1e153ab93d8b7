#include "controller/planning/start/start_choice.hpp"

#include <cmath>

namespace qsmpc::controller {

StartChoice::StartChoice(const models::Dynamics& dynamics, const PlannerSettings& settings,
                         PlanEvaluator& evaluator)
    : evaluator_(evaluator),
      no_noise_(Eigen::MatrixXd::Zero(dynamics.state_dim(), dynamics.state_dim())),
      noise_free_(settings.horizon, {.dynamics = dynamics,
                                     .safe_set = settings.safe_set,
                                     .cost = evaluator.weights(),
                                     .penalty = settings.penalty,
                                     .noise_covariance = no_noise_,
                                     .within_covariance = no_noise_}),
      guess_(settings),
      gain_change_(Eigen::MatrixXd::Zero(dynamics.input_dim(), dynamics.state_dim())) {
  const SafeSet& safe_set = settings.safe_set;
  if (!safe_set.obstacles.empty() || safe_set.road != nullptr || settings.risk.any()) {
    minima_.emplace(settings, noise_free_);
  }
}

/// With risk limits, the noise-free cost includes the excess over them, by the surrogate of the
/// shifted previous plan or, without one, of constant inputs.
void StartChoice::hold_risk(const Plan* previous, PlanInProgress& plan) {
  RiskConstraint* risk = evaluator_.risk();
  if (risk == nullptr) return;
  risk->start(previous != nullptr);
  if (previous != nullptr) {
    shift_inputs(previous->policy.inputs, shifted_);
  } else {
    shifted_ = guess_.middle();
  }
  evaluator_.set_policy(shifted_, gain_change_, *plan.current);
  evaluator_.hold_risk(plan.current->policy);
  noise_free_.set_excess({});
  const double cost = noise_free_.evaluate(shifted_, gain_change_, evaluator_.policies());
  noise_free_.set_excess(
      [risk](const Eigen::VectorXd& z, double weight, Eigen::VectorXd* gradient) {
        return risk->add_excess(z, weight, gradient);
      });
  noise_free_.set_excess_weight(std::isfinite(cost) ? std::abs(cost) : 1.0);
}

void StartChoice::choose(const Gaussian& belief, Plan* previous, PlanInProgress& plan) {
  if (previous != nullptr) {
    gain_change_ = previous->gain_change;
  } else {
    gain_change_.setZero();
  }
  noise_free_.place(belief);
  hold_risk(previous, plan);
  plan.warm = guess_.compare(previous != nullptr ? &previous->policy.inputs : nullptr, gain_change_,
                             noise_free_, evaluator_.policies());
  if (previous != nullptr && plan.warm) {
    evaluator_.set_policy(guess_.shifted(), gain_change_, *plan.current);
    if (evaluator_.can_freeze(*previous)) {
      previous->prediction.stages[0] = evaluator_.belief().measure;
      evaluator_.freeze_assignments(previous->prediction, plan.current->policy);
    } else {
      evaluator_.predict_and_evaluate(*plan.current);
      plan.evaluated = true;
    }
    plan.warm = !constant_is_clearly_cheaper(*previous, plan);
  }
  if (plan.warm) return;
  if (minima_) {
    take_best_minimum(plan);
  } else if (plan.evaluated) {
    plan.accept_candidate();  // the constant inputs, which won
    evaluator_.hold(*plan.current);
  } else {
    evaluator_.set_policy(guess_.constant(), gain_change_, *plan.current);
    evaluator_.predict_and_evaluate(*plan.current);
    plan.evaluated = true;
  }
}

/// Whether the best constant inputs are clearly cheaper than the shifted previous plan (the current
/// one) with noise as well. Both are predicted unless the held assignments rule it out. Leaves the
/// assignments for the current plan held.
bool StartChoice::constant_is_clearly_cheaper(const Plan& previous, PlanInProgress& plan) {
  // Only a necessary condition: without noise, many constant inputs look better than a plan that is
  // careful because of it.
  if (!(guess_.advantage() > 0.0)) return false;
  Plan& current = *plan.current;
  Plan& constant = *plan.candidate;
  evaluator_.set_policy(guess_.constant(), gain_change_, constant);
  if (!plan.evaluated) {
    const double shifted = evaluator_.evaluate_frozen(current);
    evaluator_.freeze_assignments(previous.prediction, constant.policy);
    const bool possible = clearly_cheaper(evaluator_.evaluate_frozen(constant), shifted);
    if (!possible || plan.late()) {
      evaluator_.freeze_assignments(previous.prediction, current.policy);
      return false;
    }
  }
  evaluator_.predict_and_evaluate(constant);
  if (plan.evaluated) {
    evaluator_.hold(current);
  } else {
    evaluator_.predict_and_evaluate(current);
    plan.evaluated = true;
  }
  if (constant.risk.kept != current.risk.kept) return constant.risk.kept;
  return clearly_cheaper(constant.cost.total(), current.cost.total());
}

/// Sets the current plan to the cheapest, as predicted with noise, among the search's minima and
/// itself if it has been evaluated, and freezes its assignments.
void StartChoice::take_best_minimum(PlanInProgress& plan) {
  bool held = plan.evaluated;
  for (const Eigen::MatrixXd* const inputs :
       minima_->search(evaluator_.policies(), plan.deadline)) {
    if (plan.evaluated && plan.late()) break;
    Plan& one = plan.evaluated ? *plan.candidate : *plan.current;
    evaluator_.set_policy(*inputs, gain_change_, one);
    if (plan.evaluated) {
      held = evaluator_.predict_if_better(one, *plan.current);
      if (held) plan.accept_candidate();
    } else {
      evaluator_.predict_and_evaluate(one);
      held = true;
      plan.evaluated = true;
    }
  }
  if (!held) evaluator_.hold(*plan.current);
}

}  // namespace qsmpc::controller
