// The receding-horizon planner on the quantised belief (Algorithm 5).
#include "controller/control/controller_entries.hpp"
#include "controller/control/planning_controller.hpp"

namespace qsmpc::controller {

ControllerEntry quantised_controller() {
  return {.name = "quantised",
          .summary = "plans for the quantised belief with its noise, in open or closed loop",
          .parts = PlanningController::parts,
          .make = [](const models::Dynamics& dynamics,
                     const ControllerSettings& settings) -> std::unique_ptr<Controller> {
            return std::make_unique<PlanningController>(dynamics, settings);
          },
          .keeps_limits = true,
          .takes_guide = true};
}

}  // namespace qsmpc::controller
