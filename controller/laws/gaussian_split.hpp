// A Gaussian as a mixture of narrower ones, split along one direction.
#pragma once

#include "controller/laws/stage_law.hpp"

namespace qsmpc::controller {

/// N(0, 1) as Σ weights_i N(means_i, deviation²).
struct NormalSplit {
  Eigen::VectorXd weights;
  Eigen::VectorXd means;
  double deviation = 1.0;
};

/// The split into 3 or 5 parts: the nodes and weights of the Gauss-Hermite rule, contracted by
/// √(1 − deviation²), so that moments agree with those of N(0, 1) up to order 5 or 9. The
/// deviations are 0.7 and 0.55: W2 to N(0, 1) is 0.018 and 0.014, and the densities differ by 4 and
/// 5 % in the mean square.
[[nodiscard]] const NormalSplit& normal_split(int parts);

/// `gaussian` split along S z, where S is its covariance's symmetric root and z (d) a unit vector:
/// means m + means_i S z, covariances S (I − (1 − deviation²) z zᵀ) S. Mean and covariance of the
/// mixture are the Gaussian's.
[[nodiscard]] GaussianMixture split_gaussian(const Gaussian& gaussian,
                                             const Eigen::VectorXd& direction,
                                             const NormalSplit& split);

}  // namespace qsmpc::controller
