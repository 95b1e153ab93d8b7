// A change of measure for the noise along a plan: the law of the path with one or more of its
// linear functionals held near given values. As densities, N(0, 1) ≤ Σ ρ_i N(c_i, w²), so the
// probability of an event of the path is at most the sum of its probabilities under the tilted
// laws, weighted by ρ_i. Under these laws everything stays Gaussian, with smaller deviations.
// Derivation: docs/theory/conditioning.md.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/prediction/prediction.hpp"

namespace qsmpc::controller {

/// Functionals a = Σ_j Λ_jᵀ ξ_j of the path's noise (ξ_0 = x_0 − its mean, ξ_{j+1} = w_j), r of
/// them, uncorrelated and of variance 1.
struct PathFunctionals {
  std::vector<Eigen::MatrixXd> weights;  ///< horizon + 1, n x r: Λ_j; empty where r is 0
  std::vector<Eigen::MatrixXd> moves;    ///< the same: Γ_j = Cov(ξ_j, a) = Cov(ξ_j) Λ_j

  /// r
  [[nodiscard]] Eigen::Index count() const { return weights.empty() ? 0 : weights[0].cols(); }
};

/// The law under which a ~ N(centre, diag(spreads²)), and everything independent of a keeps its
/// law.
struct PathTilt {
  PathFunctionals functionals{};
  Eigen::VectorXd centre{};   ///< r
  Eigen::VectorXd spreads{};  ///< r; w, each in (0, 1)

  [[nodiscard]] bool empty() const { return functionals.count() == 0; }
};

/// Adds a functional with these weights to `functionals`, made uncorrelated with the existing ones
/// and scaled to variance 1. Returns false and adds nothing if no variance is left after that, up
/// to rounding.
[[nodiscard]] bool add_functional(const PredictedMotion& motion,
                                  const std::vector<Eigen::VectorXd>& weights,
                                  PathFunctionals& functionals);

/// Covariance of the part of ξ_block that is independent of all other blocks under the tilt.
/// covariance: of ξ_block without it.
[[nodiscard]] Eigen::MatrixXd independent_part(const Eigen::MatrixXd& covariance,
                                               const PathTilt& tilt, Eigen::Index block);

/// Whether the functionals' weights on ξ_block are zero except for its coordinate `axis` (−1: all
/// zero).
[[nodiscard]] bool concerns_only(const PathTilt& tilt, Eigen::Index block, Eigen::Index axis);

/// Places c_i and weights ρ_i of narrow laws: Σ ρ_i N(c_i, w²) is at least N(0, 1) everywhere, but
/// for places too far out to be listed.
struct TiltGrid {
  Eigen::VectorXd places{};
  Eigen::VectorXd weights{};
  double left_out = 0.0;  ///< bounds the sum of the weights of places that are not listed
};

/// The grid for 0 < w < 1.
[[nodiscard]] TiltGrid tilt_grid(double spread);

}  // namespace qsmpc::controller
