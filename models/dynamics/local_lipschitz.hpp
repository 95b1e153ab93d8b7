// A Lipschitz constant over a box, for systems that have no global one.
#pragma once

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

/// A rigorous upper bound of the Lipschitz constant, in the Euclidean norm, of the closed loop
/// x ↦ f(x, sat(v + K (x − x̄))) over a box of states, for all v and x̄, where `sat` clamps to a box
/// of inputs.
/// bounds: those of f over a box that contains these states and inputs, see
/// Dynamics::derivative_bounds. gain: K, input_dim x state_dim; zero for an open-loop policy.
/// Infinity if a relevant entry is unbounded. Throws std::invalid_argument if the sizes of `bounds`
/// and `gain` do not match.
[[nodiscard]] double local_lipschitz(const DerivativeBounds& bounds,
                                     const Eigen::Ref<const Eigen::MatrixXd>& gain);

}  // namespace qsmpc::models
