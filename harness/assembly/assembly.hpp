// From what a scenario says to what the controller is made of.
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

/// What a motion's belief is the law of.
enum class BeliefOf {
  kPrediction,  ///< in period 0 the state; later the model's prediction of it from a known state,
                ///< from which a plant's state differs by the error of the period before
  kState,       ///< the state itself, once it has been observed
};

/// `motion`, from period `period` ≥ 0 of a drive on, for the plant of `scenario`: with its model
/// error, if it states one, which it refers to and must outlive it.
[[nodiscard]] controller::PredictedMotion of_plant(controller::PredictedMotion motion,
                                                   const Scenario& scenario, Eigen::Index period,
                                                   BeliefOf belief = BeliefOf::kPrediction);

/// The planner's settings of `scenario`.
[[nodiscard]] controller::PlannerSettings planner_settings(const Scenario& scenario);

/// What the controller of `scenario` is made from.
[[nodiscard]] controller::ControllerSettings controller_settings(const Scenario& scenario);

/// The controller of `scenario`, one outside of the program included. `dynamics` must
/// outlive it. Throws std::invalid_argument on settings that make
/// no sense, and InputError where the controller is an object of another program.
[[nodiscard]] std::unique_ptr<controller::Controller> make_controller(
    const Scenario& scenario, const models::Dynamics& dynamics);

/// What decisions of the controller of `scenario` have.
[[nodiscard]] controller::DecisionParts decision_parts(const Scenario& scenario);

/// "closed-loop policy, horizon 8", and before it the controller's kind if it is not the default.
[[nodiscard]] std::string controller_words(const Scenario& scenario);

/// Stages of which certificates speak in a period: those of the policy, or the next one alone.
[[nodiscard]] int certified_stages(const controller::DecisionParts& parts);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
