// Probabilities of rectangles under the bivariate normal distribution.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

/// P(lower ≤ x ≤ upper) for x ~ N(mean, covariance) in the plane, to an absolute error of at most
/// `rectangle_error`; by Owen's T function. lower ≤ upper, infinite where not restricted; the
/// covariance may be singular.
[[nodiscard]] double rectangle_probability(const Eigen::Vector2d& mean,
                                           const Eigen::Matrix2d& covariance,
                                           const Eigen::Vector2d& lower,
                                           const Eigen::Vector2d& upper);

/// Bounds the error of `rectangle_probability` under this covariance. Near r = ±1, P changes with
/// the correlation r as fast as 1/√(1 − r²), so that the rounding of r matters.
[[nodiscard]] double rectangle_error(const Eigen::Matrix2d& covariance);

/// The same where the coordinates are far from linearly dependent.
inline constexpr double kRectangleError = 1e-14;

}  // namespace qsmpc::controller
