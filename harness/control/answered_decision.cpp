#include "harness/control/answered_decision.hpp"

#include "controller/planning/cost/angular_target.hpp"

namespace qsmpc::harness {

controller::DecisionParts outside_parts(const Scenario::Controller& controller) {
  if (!controller.outside.plans) return {};
  return {.stages = controller.horizon, .cost = true, .status = true};
}

AnsweredDecision::AnsweredDecision(const Scenario& scenario, const models::Dynamics& dynamics)
    : dynamics_(dynamics),
      bounds_{.lower = scenario.controller.input_lower, .upper = scenario.controller.input_upper},
      stages_(outside_parts(scenario.controller).stages),
      cost_{.state = scenario.controller.cost.state,
            .input = scenario.controller.cost.input,
            .terminal = scenario.controller.cost.terminal,
            .target = scenario.target.state,
            .angles = scenario.target.angles},
      route_(scenario.target.route),
      nearest_(cost_) {}

const controller::Decision& AnsweredDecision::take(const ControllerAnswer& answer,
                                                   const controller::Situation& situation,
                                                   double optimise_ms) {
  decision_.timing.optimise = optimise_ms;
  decision_.believed = answer.believed;
  if (stages_ == 0) {
    decision_.input = answer.input;
    return decision_;
  }
  policy_.inputs = answer.policy.inputs;
  policy_.gains = answer.policy.gains;
  policy_.bounds = bounds_;
  controller::nominal_states(dynamics_, situation.belief.mean, policy_.inputs, policy_.states);
  controller::policy_input(policy_, 0, situation.observation, offset_, decision_.input);
  if (route_) cost_.target = route_->next(situation.progress.value_or(0.0));
  controller::nearest_target(cost_.target, cost_.angles, situation.belief.mean, nearest_.target);
  decision_.policy = &policy_;
  decision_.cost = controller::path_cost(policy_, nearest_, cost_scratch_);
  decision_.status = answer.status;
  decision_.evaluations = answer.evaluations;
  return decision_;
}

}  // namespace qsmpc::harness
