// Turns a Gaussian into a discrete measure with a known error: the product of optimal
// one-dimensional quantisers on the axes of the covariance's eigenbasis.
//
//   const GaussianQuantisation q = quantise(belief, 100);
//   q.measure;  // at most 100 weighted points, with the belief's mean
//   q.w2;       // its exact 2-Wasserstein distance to the belief
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc {

struct GaussianQuantisation {
  DiscreteMeasure measure;
  double w2 = 0.0;                    ///< exact: the cells are the points' Voronoi cells
  Eigen::MatrixXd within_covariance;  ///< d x d; covariance = cov(measure) + within_covariance
  std::vector<int> levels;            ///< points on each eigenaxis, eigenvalues increasing
};

/// Levels n_j ≥ 1 with Π n_j ≤ budget that minimise Σ variances_j D(n_j), D the distortion of the
/// optimal one-dimensional quantiser (beyond kExactDistortions points its asymptote): by exhaustive
/// search over shapes whose levels do not grow where the variance falls. Axes of zero variance get
/// one level. Throws std::invalid_argument if budget < 1 or a variance is negative or not finite.
[[nodiscard]] std::vector<int> allot_levels(const Eigen::Ref<const Eigen::VectorXd>& variances,
                                            int budget);

/// The best product quantiser of `gaussian` with at most `budget` points. Each point is the
/// centroid of its cell, so the mean is kept exactly, and W2² = Σ λ_j D(n_j) =
/// tr(within_covariance) (docs/theory/quantisation.md). Throws std::invalid_argument as
/// check_gaussian and allot_levels.
[[nodiscard]] GaussianQuantisation quantise(const Gaussian& gaussian, int budget);

}  // namespace qsmpc
