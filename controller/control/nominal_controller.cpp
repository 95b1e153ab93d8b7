// Nominal (certainty-equivalent) model predictive control: the same problem on the mean of the
// belief, without noise, and the same policy about the solution. The baseline without any notion of
// risk.
#include <limits>

#include "controller/control/controller_entries.hpp"
#include "controller/control/planning_controller.hpp"

namespace qsmpc::controller {
namespace {

ControllerSettings mean_only(ControllerSettings settings) {
  settings.problem.propagator = "noise_free";
  settings.problem.state_points = 1;
  settings.problem.quantiser = QuantiserKind::kProduct;
  // Without noise there is no risk to limit.
  settings.problem.risk = {};
  settings.mission = std::numeric_limits<double>::infinity();
  return settings;
}

std::unique_ptr<Controller> make_nominal(const models::Dynamics& dynamics,
                                         const ControllerSettings& settings) {
  return std::make_unique<PlanningController>(dynamics, mean_only(settings));
}

}  // namespace

ControllerEntry nominal_controller() {
  return {.name = "nominal",
          .summary = "plans for the mean of the belief, as if there were no noise",
          .parts =
              [](const ControllerSettings& settings) {
                return PlanningController::parts(mean_only(settings));
              },
          .make = make_nominal,
          .takes_guide = true};
}

}  // namespace qsmpc::controller
