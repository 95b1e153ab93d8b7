// A scenario's decision before anything is observed, for inspecting a plan without a drive.
#pragma once

#include <memory>
#include <optional>

#include "controller/control/controller.hpp"
#include "controller/control/decision_motion.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The decision at the initial belief, with its mean as the observation, and the motion that
/// follows without further decisions: the policy's stages, or the single stage of a held input.
class FirstDecision {
 public:
  /// Refers to the dynamics. Throws std::invalid_argument as the controller's maker.
  FirstDecision(const Scenario& scenario, const models::Dynamics& dynamics);

  [[nodiscard]] const controller::Decision& decision() const { return *decision_; }
  /// Refers to this object.
  [[nodiscard]] const controller::PredictedMotion& motion() const { return *motion_; }

 private:
  controller::Gaussian belief_;
  controller::DecisionMotion motions_;
  std::unique_ptr<controller::Controller> controller_;
  const controller::Decision* decision_ = nullptr;  // owned by the controller
  std::optional<controller::PredictedMotion> motion_;
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
