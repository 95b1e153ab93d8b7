// Builds the controller and its settings from a scenario.
#pragma once

#include <memory>
#include <string>

#include "controller/control/controller.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/prediction.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The planner's model of `scenario`.
[[nodiscard]] std::unique_ptr<const models::Dynamics> model_of(const Scenario& scenario);

/// The quantity whose law a motion's belief is.
enum class BeliefOf {
  kPrediction,  ///< in period 0 the state; later the model's prediction from a known state,
                ///< from which a plant's state differs by the last period's model error
  kState,       ///< the state itself, once it has been observed
};

/// `motion`, from period `period` ≥ 0 of a drive on, for the plant of `scenario`: with the
/// scenario's model error, if it states one. The motion refers to it, so `scenario` must outlive
/// the result.
[[nodiscard]] controller::PredictedMotion of_plant(controller::PredictedMotion motion,
                                                   const Scenario& scenario, Eigen::Index period,
                                                   BeliefOf belief = BeliefOf::kPrediction);

/// The planner's settings of `scenario`.
[[nodiscard]] controller::PlannerSettings planner_settings(const Scenario& scenario);

/// The settings of the controller of `scenario`.
[[nodiscard]] controller::ControllerSettings controller_settings(const Scenario& scenario);

/// The controller of `scenario`, including one outside the program. `dynamics` must outlive it.
/// Throws std::invalid_argument on inconsistent settings, and InputError where the controller is an
/// object of another program.
[[nodiscard]] std::unique_ptr<controller::Controller> make_controller(
    const Scenario& scenario, const models::Dynamics& dynamics);

/// The parts of the decisions that the controller of `scenario` makes.
[[nodiscard]] controller::DecisionParts decision_parts(const Scenario& scenario);

/// "closed-loop policy, horizon 8", preceded by the controller's kind if it is not the default.
[[nodiscard]] std::string controller_words(const Scenario& scenario);

/// The number of stages certified in each period: those of the policy, or only the next one.
[[nodiscard]] int certified_stages(const controller::DecisionParts& parts);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
