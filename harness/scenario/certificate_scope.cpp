#include "harness/scenario/certificate_scope.hpp"

#include "harness/scenario/known_names.hpp"
#include "harness/scenario/outside_controllers.hpp"

namespace qsmpc::harness {
namespace {

/// Whether the input depends on the observed state.
bool has_feedback(const Scenario::Controller& controller) {
  const std::string& kind = controller.kind;
  if (kind == "lqr" || kind == "tube" || kind == "shield" || is_outside(controller)) return true;
  if (controller.policy != "closed_loop" || is_sampling(controller)) return false;
  const bool is_zero = controller.feedback_gain && controller.feedback_gain->isZero(0.0);
  return !is_zero || controller.optimise_gain;
}

}  // namespace

std::string why_no_bound(const Scenario& scenario) {
  if (scenario.model.own && !scenario.model.own->differentiable) {
    return "the library of " + scenario.model.system +
           " provides no derivatives: plans use finite differences, and certificates are 1";
  }
  for (const controller::Obstacle& obstacle : scenario.safe_set.obstacles) {
    if (!obstacle.motion || obstacle.motion->yields == 0.0) continue;
    return "an obstacle waits for the vehicle (motion.yields), but certificates assume that it "
           "does not";
  }
  if (scenario.disturbance.sensor.isZero(0.0) || !has_feedback(scenario.controller)) return {};
  return "with measurement noise (disturbance.sensor), the feedback acts on what is observed, not "
         "on the true state";
}

}  // namespace qsmpc::harness
