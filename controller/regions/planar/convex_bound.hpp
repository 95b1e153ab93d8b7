// Bounds for certificates of a Gaussian and a convex part of the plane. They project both on two
// directions, in which the part lies in a rectangle (docs/theory/shapes.md).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/planar/planar_shape.hpp"
#include "controller/regions/soft_part.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

/// Indices of the states that span the plane.
struct PlaneAxes {
  Eigen::Index x = 0;
  Eigen::Index y = 1;
};

/// Two unit directions, as rows; only the first matters for a half-plane.
using DirectionPair = Eigen::Matrix2d;

/// The direction from the part to the mean and its perpendicular: the only pair needed if the part
/// is far away.
[[nodiscard]] DirectionPair nearest_pair(const ConvexPart& part, const Eigen::Vector2d& mean);

/// Further pairs in which the rectangle about the part contains little of the law beyond the part:
/// the direction from the part to the mean with the uncorrelated one, and the direction of the
/// least separation in standard deviations with the uncorrelated one or the perpendicular. None for
/// a half-plane or a singular covariance.
[[nodiscard]] std::vector<DirectionPair> other_pairs(const ConvexPart& part,
                                                     const Eigen::Vector2d& mean,
                                                     const Eigen::Matrix2d& covariance);

/// A bound of a part at or below this value is not refined.
inline constexpr double kNegligiblePart = 1e-8;

/// A bound of P(z + e in the circle), tight if the circle is far away: half of the distance is
/// allotted to z, the other half to e. 1 unless the mean is outside the circle. spread: covariance
/// in the plane that z has in addition to that of its law.
[[nodiscard]] double far_probability(const SurrogateLaw& state, const Circle& circle,
                                     PlaneAxes axes,
                                     const Eigen::Matrix2d& spread = Eigen::Matrix2d::Zero());

/// Bounds C3 and C4 of P(z + e in the part): the least, over all pairs, of the bounds for the
/// rectangle in the projections (box_part.hpp), whose errors are bounded by the triangle
/// inequality.
[[nodiscard]] RegionProbability convex_probability(const SurrogateLaw& state,
                                                   const ConvexPart& part, PlaneAxes axes);

/// The part of a bound of E(1 − d(y, part)²/t²)₊, y ~ N(mean, covariance), that does not depend on
/// t.
[[nodiscard]] SoftPart soft_convex(const ConvexPart& part, const Eigen::Vector2d& mean,
                                   const Eigen::Matrix2d& covariance);

}  // namespace qsmpc::controller
