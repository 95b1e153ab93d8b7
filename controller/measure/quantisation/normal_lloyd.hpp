// Centroidal quantisers of the standard normal distribution in two to six dimensions.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// A quantiser of N(0, I) and the covariance that it loses under a known coupling.
struct NormalLloyd {
  DiscreteMeasure measure;  ///< each point is the mean of the mass moved to it
  /// d x d, E(x − q)(x − q)ᵀ for the coupling (x, q) behind the measure. It and the measure's
  /// covariance sum to the identity; its trace bounds W2² from above. The diagonal decreases.
  Eigen::MatrixXd within_covariance;
};

/// Lloyd's method for N(0, I) in `dim` dimensions with `count` points, from the split tree of
/// `compress`, deterministically. It works on a product grid of about 600 cells per point, each
/// with its exact mass and mean; the cost of the coupling that moves every cell to one point is
/// counted in full, so that the bound holds wherever the cells lie (docs/theory/quantisation.md).
/// Results are cached for the life of the process; the first call for a pair takes from 0.1 s to a
/// few seconds, during which other calls wait. Thread-safe. Throws std::invalid_argument unless
/// 2 ≤ dim ≤ kLloydDimensions and 1 ≤ count ≤ kLloydPoints.
[[nodiscard]] const NormalLloyd& normal_lloyd(int dim, int count);

inline constexpr int kLloydDimensions = 6;
/// Above this the grid would need too many cells (and Lloyd's method too much time).
inline constexpr int kLloydPoints = 2048;

}  // namespace qsmpc::controller
