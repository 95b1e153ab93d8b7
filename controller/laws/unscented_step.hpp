// The scaled unscented transform of the closed loop.
#pragma once

#include "controller/laws/law_propagator.hpp"

namespace qsmpc::controller {

/// Throws std::invalid_argument unless α² (d + κ) > 0 and α² (d + κ) ≥ d (α² − β), without which
/// covariances may fail to be positive semidefinite.
void check_unscented(const UnscentedSettings& settings, Eigen::Index dim);

/// The mixture after the period of `stage`: every component moved by the transform, its covariance
/// that of the sigma points plus that of the noise. settings: as check_unscented accepts them.
///
/// With s² = α² (d + κ), the root S of the covariance and δ_j = g(m ± s S_j) − g(m) over all 2d,
/// the weights of the scaled transform (Julier 2002; Wan and van der Merwe 2000) come to
///   mean = g(m) + μ,  μ = Σ δ_j/(2s²),  covariance = Σ δ_j δ_jᵀ/(2s²) + (β − α²) μ μᵀ,
/// in which no large weights cancel.
[[nodiscard]] GaussianMixture unscented_step(const LawProblem& problem, Eigen::Index stage,
                                             const GaussianMixture& law,
                                             const UnscentedSettings& settings);

}  // namespace qsmpc::controller
