// The exactly Gaussian surrogate of an open-loop unicycle (bound C3).
//
// Open loop the heading φ_j is Gaussian, and the position p_k = p_0 + a Σ_{j<k} (cos φ_j, sin φ_j)
// + noise is nonlinear in it only. Replacing each e^{iφ} by its best affine fit under φ ~ N(m, v),
// e^{im − v/2}(1 + i(φ − m)), gives a Gaussian, and the mean square of what is left has a closed
// form (docs/theory/certificates.md, section 4).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

struct GaussianSurrogate {
  Gaussian law;         ///< of the surrogate state, dimension 3
  double radius = 0.0;  ///< √E|x − surrogate|², under a coupling of both
};

/// Surrogates of stages 1 … inputs.size(), of the unicycle from `belief` under the open-loop inputs
/// `inputs` and independent noise N(0, noise_covariance) a step.
[[nodiscard]] std::vector<GaussianSurrogate> unicycle_surrogates(
    const UnicycleStructure& unicycle, const Gaussian& belief, const Eigen::VectorXd& inputs,
    const Eigen::MatrixXd& noise_covariance);

}  // namespace qsmpc
