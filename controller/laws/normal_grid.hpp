// Quadrature for the standard normal law in several dimensions.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// Σ weights_q g(nodes_q) ≈ E g(ξ), ξ ~ N(0, I).
struct NormalGrid {
  Points nodes;             ///< dim x n
  Eigen::VectorXd weights;  ///< n, sums to one; some are negative if the grid is sparse
};

/// The Gauss-Hermite rule of `count` ≥ 1 nodes, ascending: exact up to degree 2 count − 1.
/// (Golub and Welsch: "Calculation of Gauss quadrature rules", 1969.)
[[nodiscard]] NormalGrid gauss_hermite(int count);

/// The product of Gauss-Hermite rules of order + 1 nodes, where that has at most `most_nodes`
/// nodes; otherwise Smolyak's sparse grid of level `order`. Both are exact for polynomials of a
/// total degree of up to 2 order + 1. dim, order ≥ 1. (Heiss and Winschel: "Likelihood
/// approximation by numerical integration on sparse grids", 2008.)
[[nodiscard]] NormalGrid normal_grid(Eigen::Index dim, int order, int most_nodes);

}  // namespace qsmpc::controller
