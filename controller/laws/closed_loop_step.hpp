// One period of the closed loop for many states at once.
#pragma once

#include "controller/laws/law_propagator.hpp"

namespace qsmpc::controller {

/// g(x) = f(x, sat(v + K (x − x̄))) at `stage` for every column of `states` (state_dim x n), without
/// noise.
[[nodiscard]] inline Points closed_loop_step(const LawProblem& problem, Eigen::Index stage,
                                             const Points& states) {
  Points inputs(problem.policy.inputs.rows(), states.cols());
  policy_inputs(problem.policy, stage, states, inputs);
  Points next(states.rows(), states.cols());
  problem.dynamics.step(states, inputs, next);
  return next;
}

}  // namespace qsmpc::controller
