// The answer of a controller outside the program in one period, its checks, and the decision made
// from it.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "controller/planning/solvers/solver_status.hpp"
#include "controller/prediction/policy.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// An answer to a situation.
struct ControllerAnswer {
  Eigen::VectorXd input{};      ///< input_dim, within the bounds; empty if a plan is requested
  controller::Policy policy{};  ///< the plan's inputs, within the bounds, and gains (none: open
                                ///< loop); its other members are not used
  controller::SolverStatus status = controller::SolverStatus::kConverged;  ///< of the plan
  int evaluations = 0;                                                     ///< of cost and gradient
  /// The controller's own estimate, from 0 to 1, of the probability that the state at the end of
  /// the period is unsafe; nothing if it gives none.
  std::optional<double> believed{};
};

#pragma GCC visibility pop

/// The required form of an answer.
struct AnswerShape {
  const models::SystemDescription& system;
  const controller::InputBounds& bounds;
  int stages = 0;  ///< of the plan; 0: an input is requested, not a plan
};

/// An invalid answer, in the words of an error.
struct WrongAnswer {
  std::string found;
  std::string expected;
};

/// Throws WrongAnswer unless `input`, called `what` in messages, has one finite number within the
/// bounds for each input.
void check_input(const Eigen::VectorXd& input, const AnswerShape& shape, const std::string& what);

/// Throws WrongAnswer unless `believed` is a probability.
void check_believed(double believed);

/// Throws WrongAnswer unless `answer` has this shape. Missing gains become zeros.
void complete_answer(ControllerAnswer& answer, const AnswerShape& shape);

}  // namespace qsmpc::harness
