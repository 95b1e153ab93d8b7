// What certificates need of convex parts of the plane, as a Gaussian sees them: projections on two
// directions, in which a part lies in a rectangle (docs/theory/shapes.md).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/planar/planar_shape.hpp"
#include "controller/regions/soft_part.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

/// The states that are the plane.
struct PlaneAxes {
  Eigen::Index x = 0;
  Eigen::Index y = 1;
};

/// Two directions of length 1, in rows; for a half-plane the first alone is of use.
using DirectionPair = Eigen::Matrix2d;

/// The direction from the part to the mean, and the one across: the only pair that is needed where
/// the part is far away.
[[nodiscard]] DirectionPair nearest_pair(const ConvexPart& part, const Eigen::Vector2d& mean);

/// More pairs in which a rectangle about the part leaves little of the law besides: along the way
/// that is shortest in deviations, and uncorrelated or across. None for a half-plane.
[[nodiscard]] std::vector<DirectionPair> other_pairs(const ConvexPart& part,
                                                     const Eigen::Vector2d& mean,
                                                     const Eigen::Matrix2d& covariance);

/// What a part may add without being worked out further.
inline constexpr double kNegligiblePart = 1e-8;

/// A bound of P(z + e in the circle), good where that is far away: half of the way to it is left to
/// z, the other half to e. 1 where the mean is not outside of it. spread: covariance in the plane
/// that z has besides that of its law.
[[nodiscard]] double far_probability(const SurrogateLaw& state, const Circle& circle,
                                     PlaneAxes axes,
                                     const Eigen::Matrix2d& spread = Eigen::Matrix2d::Zero());

/// Bounds C3 and C4 of P(z + e in the part): for each pair those of the rectangle in the
/// projections (box_part.hpp), whose errors are bounded by the triangle inequality; of all pairs
/// the least.
[[nodiscard]] RegionProbability convex_probability(const SurrogateLaw& state,
                                                   const ConvexPart& part, PlaneAxes axes);

/// What does not depend on t of a bound of E(1 − d(y, part)²/t²)₊ for y ~ N(mean, covariance).
[[nodiscard]] SoftPart soft_convex(const ConvexPart& part, const Eigen::Vector2d& mean,
                                   const Eigen::Matrix2d& covariance);

}  // namespace qsmpc::controller
