// Enclosures of a tape's derivatives over a box.
#pragma once

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/tape.hpp"

namespace qsmpc::models {

/// Enclosures for the outputs of `tape`, which has at most kMostCoordinates arguments, over
/// arguments from `lower` to `upper`.
[[nodiscard]] DerivativeBounds derivative_bounds_of(const Tape& tape,
                                                    const Eigen::Ref<const Eigen::VectorXd>& lower,
                                                    const Eigen::Ref<const Eigen::VectorXd>& upper);

}  // namespace qsmpc::models
