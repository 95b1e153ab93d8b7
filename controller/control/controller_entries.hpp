// Entries of the table of controllers, each defined in the file of its controller.
#pragma once

#include "controller/control/controller.hpp"

namespace qsmpc::controller {

ControllerEntry quantised_controller();
ControllerEntry nominal_controller();
ControllerEntry lqr_controller();
ControllerEntry shield_controller();
ControllerEntry mppi_controller();
ControllerEntry risk_mppi_controller();
// Those that share one planner, in chance_controllers.cpp.
ControllerEntry tube_controller();
ControllerEntry cone_controller();
ControllerEntry cantelli_controller();
ControllerEntry scenario_controller();
ControllerEntry cvar_controller();
ControllerEntry drcc_controller();

}  // namespace qsmpc::controller
