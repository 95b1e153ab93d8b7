// Nominal model predictive control: the same problem on the mean of the belief, without noise, and
// the same policy about what comes out. Certainty equivalence, the rival that knows no risk.
#include "controller/control/planning_controller.hpp"

namespace qsmpc::controller {
namespace {

std::unique_ptr<Controller> make_nominal(const models::Dynamics& dynamics,
                                         const ControllerSettings& settings) {
  PlannerSettings mean_only = settings.problem;
  mean_only.propagator = "noise_free";
  mean_only.state_points = 1;
  mean_only.quantiser = QuantiserKind::kProduct;
  return std::make_unique<PlanningController>(dynamics, mean_only);
}

}  // namespace

ControllerEntry nominal_controller() {
  return {.name = "nominal",
          .summary = "plans for the mean of the belief, as if there were no noise",
          .parts = PlanningController::parts,
          .make = make_nominal};
}

}  // namespace qsmpc::controller
