// From what a scenario says to what the controller is made of.
#pragma once

#include <memory>

#include "controller/planning/planner.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

/// The planner's model of `scenario`.
[[nodiscard]] std::unique_ptr<const Dynamics> model_of(const Scenario& scenario);

/// Whose law the belief of a motion is.
enum class BeliefOrigin {
  kGiven,      ///< that of the state itself
  kPredicted,  ///< the model's prediction from a known state: a plant's state differs from it
};

/// `motion` for the plant of `scenario`: with its model error, if it states one, which it refers to
/// and must outlive it.
[[nodiscard]] PredictedMotion of_plant(PredictedMotion motion, const Scenario& scenario,
                                       BeliefOrigin belief);

/// The planner's settings of `scenario`.
[[nodiscard]] PlannerSettings planner_settings(const Scenario& scenario);

}  // namespace qsmpc
