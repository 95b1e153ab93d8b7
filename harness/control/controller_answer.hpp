// What a controller that is not part of the program answers in a period, how it is checked, and the
// decision that it becomes.
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
  Eigen::VectorXd input{};      ///< input_dim, within the bounds; empty where a plan is asked for
  controller::Policy policy{};  ///< the plan's inputs, within the bounds, and gains (none: an open
                                ///< loop); the rest is not used
  controller::SolverStatus status = controller::SolverStatus::kConverged;  ///< of the plan
  int evaluations = 0;                                                     ///< of cost and gradient
  /// Its own estimate of the probability that the state at the end of the period is unsafe, from 0
  /// to 1; nothing where it has none.
  std::optional<double> believed{};
};

#pragma GCC visibility pop

/// What an answer must be.
struct AnswerShape {
  const models::SystemDescription& system;
  const controller::InputBounds& bounds;
  int stages = 0;  ///< of the plan; 0: an input is asked for, and no plan
};

/// An answer that is not what it should be, in the words of an error.
struct WrongAnswer {
  std::string found;
  std::string expected;
};

/// Throws WrongAnswer unless `input`, which messages call `what`, has a finite number within the
/// bounds for each input.
void check_input(const Eigen::VectorXd& input, const AnswerShape& shape, const std::string& what);

/// Throws WrongAnswer unless `believed` is a probability.
void check_believed(double believed);

/// Throws WrongAnswer unless `answer` is of this shape. Gains that are not there become zeros.
void complete_answer(ControllerAnswer& answer, const AnswerShape& shape);

}  // namespace qsmpc::harness
