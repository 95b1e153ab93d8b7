// The decision that the answer of a controller becomes: the plan's nominal path, what the policy
// does at what is observed, and the cost along the path.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "controller/control/path_cost.hpp"
#include "controller/reference/waypoints.hpp"
#include "harness/control/controller_answer.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// What decisions of a controller have that is not part of the program.
[[nodiscard]] controller::DecisionParts outside_parts(const Scenario::Controller& controller);

class AnsweredDecision {
 public:
  /// `dynamics` must outlive it.
  AnsweredDecision(const Scenario& scenario, const models::Dynamics& dynamics);

  /// What answers must be; refers to this object.
  [[nodiscard]] AnswerShape shape() const {
    return {.system = dynamics_.description(), .bounds = bounds_, .stages = stages_};
  }

  /// The decision for `answer`, which is of this shape, in `situation`; `optimise_ms` is how long
  /// the answer took. Valid until the next call.
  const controller::Decision& take(const ControllerAnswer& answer,
                                   const controller::Situation& situation, double optimise_ms);

 private:
  const models::Dynamics& dynamics_;
  controller::InputBounds bounds_;
  int stages_;
  controller::QuadraticCost cost_;
  std::optional<controller::Waypoints> route_;  // which the cost's target goes along
  controller::PathCostScratch cost_scratch_;
  controller::QuadraticCost nearest_;  // about what means the target, nearest to the belief
  Eigen::VectorXd offset_;
  controller::Policy policy_;
  controller::Decision decision_;
};

}  // namespace qsmpc::harness
