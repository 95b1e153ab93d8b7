#include "controller/control/decision_motion.hpp"

#include "controller/planning/planner_propagator.hpp"

namespace qsmpc::controller {

DecisionMotion::DecisionMotion(const models::Dynamics& dynamics, const PlannerSettings& settings)
    : dynamics_(dynamics),
      noise_covariance_(settings.noise_covariance),
      bounds_(settings.bounds),
      run_(settings.run),
      quantiser_(dynamics.state_dim(), settings.state_points, settings.quantiser),
      propagator_(planner_propagator(settings)) {}

PredictedMotion DecisionMotion::of(const Situation& situation, const Decision& decision,
                                   const Gaussian& posterior) {
  if (decision.policy != nullptr && decision.particles) {
    return {.dynamics = dynamics_,
            .noise_covariance = noise_covariance_,
            .noise_w2 = decision.particles->noise_w2,
            .belief = situation.belief,
            .belief_w2 = decision.particles->belief.w2,
            .policy = *decision.policy,
            .prediction = decision.particles->prediction};
  }
  if (decision.policy != nullptr) return predicted(situation.belief, *decision.policy);
  one_stage_.inputs = decision.input;
  nominal_states(dynamics_, posterior.mean, one_stage_.inputs, one_stage_.states);
  one_stage_.gains.assign(1, Eigen::MatrixXd::Zero(dynamics_.input_dim(), dynamics_.state_dim()));
  one_stage_.bounds = bounds_;
  return predicted(posterior, one_stage_);
}

PredictedMotion DecisionMotion::predicted(const Gaussian& belief, const Policy& policy) {
  quantiser_.quantise(belief, belief_);
  predict(dynamics_, *propagator_, belief_.measure, policy, run_, scratch_, prediction_);
  return {.dynamics = dynamics_,
          .noise_covariance = noise_covariance_,
          .noise_w2 = propagator_->noise_w2(),
          .belief = belief,
          .belief_w2 = belief_.w2,
          .policy = policy,
          .prediction = prediction_};
}

}  // namespace qsmpc::controller
