// Turns a controller's answer into a decision: the plan's nominal path, the policy evaluated at the
// observation, and the cost along the path.
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

/// The parts that the decisions of a controller outside the program have.
[[nodiscard]] controller::DecisionParts outside_parts(const Scenario::Controller& controller);

class AnsweredDecision {
 public:
  /// `dynamics` must outlive this object.
  AnsweredDecision(const Scenario& scenario, const models::Dynamics& dynamics);

  /// The required form of answers; refers to this object.
  [[nodiscard]] AnswerShape shape() const {
    return {.system = dynamics_.description(), .bounds = bounds_, .stages = stages_};
  }

  /// The decision for `answer`, which has this shape, in `situation`; `optimise_ms` is the duration
  /// of the answer. Valid until the next call.
  const controller::Decision& take(const ControllerAnswer& answer,
                                   const controller::Situation& situation, double optimise_ms);

 private:
  const models::Dynamics& dynamics_;
  controller::InputBounds bounds_;
  int stages_;
  controller::QuadraticCost cost_;
  std::optional<controller::Waypoints> route_;  // along which the cost's target moves
  controller::PathCostScratch cost_scratch_;
  controller::QuadraticCost nearest_;  // about the target's equivalent nearest to the belief
  Eigen::VectorXd offset_;
  controller::Policy policy_;
  controller::Decision decision_;
};

}  // namespace qsmpc::harness
