#include "controller/planning/plan_evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <compare>

#include "controller/planning/guide/guided_target.hpp"
#include "controller/planning/planner_propagator.hpp"

namespace qsmpc::controller {
namespace {

/// The penalties without that of the bounds if the solver takes these as constraints.
Penalty penalty_in_cost(const PlannerSettings& settings) {
  Penalty penalty = settings.penalty;
  if (solver_entry(settings.solver).takes_constraints) penalty.box = 0.0;
  return penalty;
}

Eigen::MatrixXd noise_in_prediction(const PlannerSettings& settings) {
  Eigen::MatrixXd noise = settings.noise_covariance;
  if (!propagator_entry(settings.propagator).carries_noise) noise.setZero();
  return noise;
}

/// Less: a plan with the first risk is better, whatever the costs.
std::weak_ordering compare_risk(const PlanRisk& risk, const PlanRisk& other) {
  if (risk.kept != other.kept) {
    return risk.kept ? std::weak_ordering::less : std::weak_ordering::greater;
  }
  const double severity = std::max(0.0, risk.severity);
  const double other_severity = std::max(0.0, other.severity);
  if (risk.kept || severity == other_severity) return std::weak_ordering::equivalent;
  return severity < other_severity ? std::weak_ordering::less : std::weak_ordering::greater;
}

}  // namespace

bool better(const Plan& plan, const Plan& other) {
  const bool feasible = plan.violation <= kConstraintTolerance;
  const bool other_feasible = other.violation <= kConstraintTolerance;
  if (feasible != other_feasible) return feasible;
  if (!feasible && plan.violation != other.violation) return plan.violation < other.violation;
  const std::weak_ordering risk = compare_risk(plan.risk, other.risk);
  if (std::is_neq(risk)) return std::is_lt(risk);
  return plan.cost.total() < other.cost.total() || !std::isfinite(other.cost.total());
}

PlanEvaluator::PlanEvaluator(const models::Dynamics& dynamics, const PlannerSettings& settings)
    : dynamics_(dynamics),
      settings_(settings),
      weights_(settings.cost),
      penalty_(penalty_in_cost(settings)),
      predicted_noise_(noise_in_prediction(settings)),
      within_(Eigen::MatrixXd::Zero(dynamics.state_dim(), dynamics.state_dim())),
      quantiser_(dynamics.state_dim(), settings.state_points, settings.quantiser),
      propagator_(planner_propagator(settings)),
      policies_(dynamics, settings),
      cost_({.dynamics = dynamics,
             .safe_set = settings.safe_set,
             .cost = weights_,
             .penalty = penalty_,
             .noise_covariance = predicted_noise_,
             .within_covariance = within_},
            settings.run),
      constraints_(cost_, settings.safe_set),
      z_(Eigen::Index{dynamics.input_dim()} * settings.horizon),
      guide_(make_guide(dynamics, settings)) {
  if (solver_entry(settings.solver).takes_constraints) constraint_set_.emplace();
  if (!constraint_set_ && CoarseCost::pays(settings)) {
    coarse_.emplace(dynamics, settings,
                    HorizonCostTerms{.dynamics = dynamics,
                                     .safe_set = settings.safe_set,
                                     .cost = weights_,
                                     .penalty = penalty_,
                                     .noise_covariance = predicted_noise_,
                                     .within_covariance = within_});
  }
  set_limits(settings.risk, 0);
}

void PlanEvaluator::set_limits(const RiskLimits& limits, Eigen::Index period) {
  if (!risk_ && limits.any()) {
    risk_.emplace(dynamics_, settings_);
    constraints_.set_risk(&*risk_);
  }
  if (risk_) risk_->set_limits(limits, period);
}

void PlanEvaluator::set_braking(bool braking) {
  const QuadraticCost& weights = settings_.cost;
  if (!braking) {
    weights_ = weights;
    place_target();
    return;
  }
  weights_.state.setZero();
  weights_.target.setZero();
  weights_.stage_targets.resize(weights_.target.size(), 0);
  weights_.angles.clear();
  for (const int speed : speeds_of(dynamics_)) weights_.state(speed, speed) = 1.0;
  weights_.terminal = weights_.state;
  weights_.input.setZero();
}

void PlanEvaluator::hold_risk(const Policy& policy) {
  if (risk_) risk_->hold(gaussian_, policy);
}

void PlanEvaluator::accept_risk(Plan& plan) {
  (void)risk_->accept(gaussian_, plan.policy, plan.risk);
}

double PlanEvaluator::excess_of(const Plan& plan, Policy& policy) {
  policies_.make(gaussian_.mean, plan.policy.inputs, plan.gain_change, policy);
  return risk_->excess(gaussian_, policy);
}

void PlanEvaluator::take_belief(const Gaussian& belief, std::optional<double> progress) {
  quantiser_.quantise(belief, belief_);
  gaussian_ = belief;
  progress_ = progress;
  if (risk_) risk_->begin();
  within_ = belief_.within_covariance;
  place_target();
}

void PlanEvaluator::place_target() {
  place_guided_target(guide_, settings_, dynamics_.description(), gaussian_.mean, progress_,
                      weights_);
}

void PlanEvaluator::set_policy(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                               const Eigen::MatrixXd& gain_change, Plan& plan) {
  plan.gain_change = gain_change;
  policies_.make(gaussian_.mean, inputs, gain_change, plan.policy);
}

void PlanEvaluator::certify(Plan& plan) {
  if (risk_) risk_->certify(gaussian_, plan.policy, plan.risk);
}

void PlanEvaluator::predict_and_evaluate(Plan& plan) {
  const auto start = std::chrono::steady_clock::now();
  certify(plan);
  predict_certified(plan);
  prediction_time_ = std::chrono::steady_clock::now() - start;
}

bool PlanEvaluator::predict_if_promising(Plan& plan, const Plan& other) {
  const auto start = std::chrono::steady_clock::now();
  certify(plan);
  // With constraints, a plan may also be better for its smaller violation.
  if (!constraint_set_ && std::is_gt(compare_risk(plan.risk, other.risk))) return false;
  predict_certified(plan);
  prediction_time_ = std::chrono::steady_clock::now() - start;
  return true;
}

void PlanEvaluator::predict_certified(Plan& plan) {
  predict(dynamics_, *propagator_, belief_.measure, plan.policy, settings_.run, scratch_,
          plan.prediction);
  freeze_assignments(plan.prediction, plan.policy);
  flatten(plan.policy);
  cost_.evaluate(z_);
  plan.cost = cost_.parts();
  plan.violation = 0.0;
  if (constraint_set_) {
    constraint_values_.resize(constraint_set_->count);
    constraint_set_->values(z_, constraint_values_);
    if (constraints_.particle_count() > 0) {
      const auto particles = constraint_values_.head(constraints_.particle_count());
      plan.violation = std::max(0.0, particles.maxCoeff() - constraints_.margin());
    }
  }
}

void PlanEvaluator::freeze_assignments(const Prediction& prediction, const Policy& policy) {
  cost_.freeze_assignments(prediction, policy);
  if (constraint_set_) constraints_.describe(prediction, *constraint_set_);
}

void PlanEvaluator::hold(Plan& plan) {
  certify(plan);
  freeze_assignments(plan.prediction, plan.policy);
}

bool PlanEvaluator::can_freeze(const Plan& plan) const {
  const Prediction& prediction = plan.prediction;
  return prediction.stages[0].weights.size() == belief_.measure.weights.size() &&
         prediction.stages[0].weights == belief_.measure.weights &&
         std::all_of(prediction.maps.begin(), prediction.maps.end(),
                     [](const StageMap& map) { return std::isfinite(map.compression_w2); });
}

double PlanEvaluator::evaluate_frozen(const Plan& plan) {
  flatten(plan.policy);
  return cost_.evaluate(z_);
}

CoarseCost* PlanEvaluator::coarse_about(const Plan& plan) {
  if (!coarse_) return nullptr;
  flatten(plan.policy);
  gradient_.resize(z_.size());
  const double value = cost_.evaluate(z_, gradient_);
  coarse_->hold(gaussian_, plan.policy);
  return coarse_->match(z_, value, gradient_) ? &*coarse_ : nullptr;
}

void PlanEvaluator::flatten(const Policy& policy) { z_ = policy.inputs.reshaped(); }

}  // namespace qsmpc::controller
