// From what a scenario says to what the controller is made of.
#pragma once

#include <memory>

#include "controller/planning/planner.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

/// The planner's model of `scenario`.
[[nodiscard]] std::unique_ptr<const Dynamics> model_of(const Scenario& scenario);

/// The planner's settings of `scenario`.
[[nodiscard]] PlannerSettings planner_settings(const Scenario& scenario);

}  // namespace qsmpc
