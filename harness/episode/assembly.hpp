// From what a scenario says to what the controller is made of.
#pragma once

#include <memory>

#include "controller/planning/planner.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The planner's model of `scenario`.
[[nodiscard]] std::unique_ptr<const models::Dynamics> model_of(const Scenario& scenario);

/// `motion`, of a plan made in period `period` ≥ 0 of a drive, for the plant of `scenario`: with
/// its model error, if it states one, which it refers to and must outlive it. In period 0 the
/// belief is the law of the state itself; later it is the model's prediction from a known state,
/// from which a plant's state differs by the error of the period before.
[[nodiscard]] controller::PredictedMotion of_plant(controller::PredictedMotion motion,
                                                   const Scenario& scenario, Eigen::Index period);

/// The planner's settings of `scenario`.
[[nodiscard]] controller::PlannerSettings planner_settings(const Scenario& scenario);

}  // namespace qsmpc::harness
