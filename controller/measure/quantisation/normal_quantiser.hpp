// Optimal quantisers of the standard normal distribution on the line.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

/// The n points that minimise W2 to N(0, 1), their cells' probabilities, and the remaining error.
struct NormalQuantiser {
  Eigen::VectorXd points;   ///< n, increasing, each the centroid of its cell
  Eigen::VectorXd weights;  ///< n, probabilities of the cells
  double distortion = 1.0;  ///< W2², exact for these points (their cells are Voronoi)
};

/// The optimal quantiser with `count` ≥ 1 points: the stationary point of the distortion, unique
/// because the normal density is log-concave; by Newton's method on its tridiagonal gradient
/// equation. Throws std::invalid_argument if count < 1. Results are cached; thread-safe.
[[nodiscard]] const NormalQuantiser& normal_quantiser(int count);

/// The W2² of the optimal quantiser with `count` points: exact up to kExactDistortions points, the
/// asymptote beyond, which serves to choose a number of points but is not a bound.
[[nodiscard]] double approximate_distortion(int count);

/// The largest number of points for which `approximate_distortion` is exact.
inline constexpr int kExactDistortions = 128;

}  // namespace qsmpc::controller
