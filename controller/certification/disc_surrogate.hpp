// The surrogate of a stage for one disc of the body: a Gaussian for the state with the disc's
// centre in place of its position, and bounds on the difference between the two. The rotated offset
// R(φ) o of a disc away from the position is treated like a unicycle's step. Derivation:
// docs/theory/surrogate.md, section 8.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/measure/measures.hpp"
#include "controller/measure/normal/norm_orders.hpp"
#include "controller/regions/disc_placement.hpp"

namespace qsmpc::controller {

struct DiscSurrogate {
  Gaussian law;           ///< of the Gaussian
  Eigen::MatrixXd turn;   ///< the Gaussian is turn · z + a constant; empty if it is z itself
  Eigen::VectorXd error;  ///< bounds √E[|difference|²; inside], coordinate by coordinate
  HigherNorms higher;     ///< the same for the norms of higher order
};

/// The surrogate for a disc. `stage` must have a finite law.
[[nodiscard]] DiscSurrogate disc_surrogate(const SurrogateStage& stage,
                                           const DiscPlacement& placement);

/// Covariance (state_dim x state_dim) of the part of a Gaussian with this `covariance` that is
/// independent of its coordinate `heading`; zero there.
[[nodiscard]] Eigen::MatrixXd given_heading(Eigen::MatrixXd covariance, Eigen::Index heading);

/// As `smoothing_covariance`, for the Gaussian and the difference above. stage ≥ 1.
[[nodiscard]] Eigen::MatrixXd disc_smoothing(const PredictedMotion& motion, Eigen::Index stage,
                                             const std::vector<Eigen::Index>& axes,
                                             const DiscPlacement& placement,
                                             const PathTilt& tilt = {});

}  // namespace qsmpc::controller
