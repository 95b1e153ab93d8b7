// The part of a plant's motion that the planner's model does not explain.
#pragma once

#include <Eigen/Core>

#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// x_{k+1} − w_k − f(x_k, u_k) for the period of `step`, in the units of the states: state_dim. w
/// is the added disturbance, so for an exact model only rounding remains. `model` is f, and
/// `next_state` is x_{k+1}.
[[nodiscard]] Eigen::VectorXd one_step_residual(const models::Dynamics& model,
                                                const StepRecord& step,
                                                const Eigen::VectorXd& next_state);

/// The residual of a period whose end is not known: `state_dim` NaNs.
[[nodiscard]] Eigen::VectorXd unknown_residual(Eigen::Index state_dim);

/// Root mean squares up to which residuals are attributed to rounding, and the plant equals the
/// model: per state (state_dim), for states of absolute value up to `magnitude` (state_dim).
[[nodiscard]] Eigen::VectorXd residual_rounding(const Eigen::VectorXd& magnitude);

/// Sets the residual of every step of `trace`, which was recorded without residuals.
void add_residuals(Trace& trace, const models::Dynamics& model);

}  // namespace qsmpc::harness
