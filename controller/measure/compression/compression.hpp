// Compression of a weighted point set to fewer points, with a known Wasserstein error.
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// A partition of a measure's points into clusters and the measure of the clusters' means.
struct Compression {
  DiscreteMeasure measure;      ///< one point per cluster; no cluster is empty
  std::vector<int> assignment;  ///< cluster of every point of the original
  double w2 = 0.0;  ///< √Σ ρ_i |c_i − c̃_{a(i)}|², the cost of the coupling i → a(i)
  Eigen::MatrixXd
      within_covariance;  ///< d x d, Σ ρ_i (c_i − c̃)(c_i − c̃)ᵀ: what the compression lost
};

/// Value of `refinements` for `compress`: refine until no point moves.
inline constexpr int kToConvergence = std::numeric_limits<int>::max();

/// Compresses `measure` to at most `count` points, deterministically.
///
/// The points are split recursively: the cluster with the largest second moment along one axis is
/// split at its mean on that axis. Then at most `refinements` rounds of reassignment to the nearest
/// mean follow (Lloyd's method), fewer if no point moves any more. The result's points are the
/// means of their clusters and its weights their masses, so that mass and mean are kept exactly (up
/// to rounding) and the lost covariance is `within_covariance`. `w2`, the cost of a coupling,
/// bounds the 2-Wasserstein distance from above:
///
/// - refinements = 0: the split tree only, a partition into boxes; the cheapest.
/// - refinements = 1, 2, …: never a larger `w2`, but still a bound: each round moves the means.
/// - kToConvergence: the clusters are the points' Voronoi cells, and `w2` is equal to the distance.
///
/// Points of weight zero are assigned but contribute nothing. Costs O(n log count), and for each
/// refinement O(count²) and as many distances as the triangle inequality leaves, O(n count) at
/// most. Throws std::invalid_argument if count < 1, refinements < 0, or as check_measure.
[[nodiscard]] Compression compress(const DiscreteMeasure& measure, int count, int refinements = 1);

}  // namespace qsmpc::controller
