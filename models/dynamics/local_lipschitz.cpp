#include "models/dynamics/local_lipschitz.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "models/constants.hpp"
#include "models/dynamics/interval.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::models {
namespace {

// Allows for rounding of midpoints, radii and norms: far more than 1e-15 per entry of a small
// matrix.
constexpr double kRoundingAllowance = 1e-12;

/// Entry (row, column) of the closed loop's Jacobian ∂f/∂x + Σ_j s_j ∂f/∂u_j K_j, with all slopes
/// s_j ∈ [0, 1] of the clamp.
Interval closed_loop_entry(const DerivativeBounds& bounds,
                           const Eigen::Ref<const Eigen::MatrixXd>& gain, Eigen::Index row,
                           Eigen::Index column) {
  const auto jacobian = [&](Eigen::Index axis) {
    return Interval(bounds.jacobian_lower(row, axis), bounds.jacobian_upper(row, axis));
  };
  Interval sum = jacobian(column);
  for (Eigen::Index input = 0; input < gain.rows(); ++input) {
    const double slope = gain(input, column);
    sum =
        sum + jacobian(gain.cols() + input) * Interval(std::min(slope, 0.0), std::max(slope, 0.0));
  }
  return sum;
}

}  // namespace

// The clamp is piecewise affine and the box is convex, so the constant is at most the largest norm
// of the Jacobian. Every Jacobian is M + R with the enclosure's midpoints M and |R| at most the
// radii entry by entry, and the norm of a matrix is at most that of the absolute values of its
// entries, which grows with them: ‖M + R‖ ≤ ‖M‖ + ‖radii‖, and ‖M + R‖ ≤ ‖ |M| + radii ‖. The first
// is the smaller of the two for small boxes.
double local_lipschitz(const DerivativeBounds& bounds,
                       const Eigen::Ref<const Eigen::MatrixXd>& gain) {
  const Eigen::Index dim = bounds.jacobian_lower.rows();
  if (gain.cols() != dim || bounds.jacobian_lower.cols() != dim + gain.rows()) {
    throw std::invalid_argument("the feedback gain does not fit the bounds of the derivatives");
  }
  Eigen::MatrixXd middle(dim, dim);
  Eigen::MatrixXd radius(dim, dim);
  for (Eigen::Index row = 0; row < dim; ++row) {
    for (Eigen::Index column = 0; column < dim; ++column) {
      const Interval entry = closed_loop_entry(bounds, gain, row, column);
      middle(row, column) = 0.5 * (entry.lower() + entry.upper());
      radius(row, column) = 0.5 * (entry.upper() - entry.lower());
    }
  }
  if (!middle.allFinite() || !radius.allFinite()) return kInfinity;
  const double split = spectral_norm(middle) + spectral_norm(radius);
  const double largest = spectral_norm(middle.cwiseAbs() + radius);
  return std::min(split, largest) * (1.0 + kRoundingAllowance);
}

}  // namespace qsmpc::models
