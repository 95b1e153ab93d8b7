// What of a plant's motion the planner's model does not explain.
#pragma once

#include <Eigen/Core>

#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// x_{k+1} − w_k − f(x_k, u_k) of the period of `step`, in the units of the states: state_dim. w is
/// the disturbance that was added, so that an exact model leaves only rounding. `model` is f, and
/// `next_state` x_{k+1}.
[[nodiscard]] Eigen::VectorXd one_step_residual(const models::Dynamics& model,
                                                const StepRecord& step,
                                                const Eigen::VectorXd& next_state);

/// Of a period whose end is not known: not a number, `state_dim` times.
[[nodiscard]] Eigen::VectorXd unknown_residual(Eigen::Index state_dim);

/// Root mean squares of residuals up to which they are rounding, and the plant is the model: by
/// state (state_dim), for states up to `magnitude` (state_dim) in size.
[[nodiscard]] Eigen::VectorXd residual_rounding(const Eigen::VectorXd& magnitude);

/// Gives every step of `trace` its residual, for a trace that was recorded without them.
void add_residuals(Trace& trace, const models::Dynamics& model);

}  // namespace qsmpc::harness
