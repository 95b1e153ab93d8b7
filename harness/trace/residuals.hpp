// What of a plant's motion the planner's model does not explain.
#pragma once

#include <Eigen/Core>

#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The true states at the control instants, in their units: state_dim x (steps + 1), or as many
/// columns as there are steps where the state after the last one is not known.
[[nodiscard]] Eigen::MatrixXd true_states(const Trace& trace);

/// How many periods the plant came through: those of which the state at the end is a result.
[[nodiscard]] Eigen::Index completed_periods(const Trace& trace);

/// x_{k+1} − w_k − f(x_k, u_k) of every period that the plant came through, one a column, in the
/// units of the states: state_dim x periods. w is the disturbance that was added, so that an exact
/// model leaves only rounding. `model` is f.
[[nodiscard]] Eigen::MatrixXd one_step_residuals(const Trace& trace, const models::Dynamics& model);

}  // namespace qsmpc::harness
