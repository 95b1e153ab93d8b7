// A Lipschitz constant over a box, for systems that have no global one.
#pragma once

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

/// A rigorous upper bound of the Lipschitz constant, in the Euclidean norm, of the closed loop
/// x ↦ f(x, sat(v + K (x − x̄))) over a box of states, for all v and x̄, where `sat` clamps to a box
/// of inputs.
/// bounds: of f over a box that contains those states and those inputs, see
/// Dynamics::derivative_bounds. gain: K, input_dim x state_dim; zero for an open-loop policy.
/// Infinity where an entry that matters is not bounded. Throws std::invalid_argument if the sizes
/// of the two do not fit.
[[nodiscard]] double local_lipschitz(const DerivativeBounds& bounds,
                                     const Eigen::Ref<const Eigen::MatrixXd>& gain);

}  // namespace qsmpc::models
