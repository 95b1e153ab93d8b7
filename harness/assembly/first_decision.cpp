#include "harness/assembly/first_decision.hpp"

#include "harness/assembly/assembly.hpp"

namespace qsmpc::harness {

FirstDecision::FirstDecision(const Scenario& scenario, const models::Dynamics& dynamics)
    : belief_{.mean = scenario.initial_state.mean, .covariance = scenario.initial_state.covariance},
      motions_(dynamics, planner_settings(scenario)),
      controller_(make_controller(scenario, dynamics)) {
  controller_->reset(scenario.seed);
  const controller::Situation situation{.belief = belief_, .observation = belief_.mean};
  decision_ = &controller_->decide(situation);
  motion_.emplace(motions_.of(situation, *decision_, belief_));
}

}  // namespace qsmpc::harness
