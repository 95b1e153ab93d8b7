// Distances of points to convex parts, and the directions that separate them.
#pragma once

#include <span>

#include <Eigen/Core>

#include "controller/regions/planar/planar_shape.hpp"

namespace qsmpc::controller {

/// The surface of a part as seen from a point.
struct SurfacePoint {
  double distance = 0.0;  ///< negative inside: minus the least distance out
  Eigen::Vector2d outward = Eigen::Vector2d::UnitX();  ///< ∂distance/∂point, a unit vector
};

[[nodiscard]] SurfacePoint nearest_surface(const ConvexPart& part, const Eigen::Vector2d& point);

/// The least distance over several parts, at least one. For points outside their union this is the
/// distance to it; inside, its magnitude is at most the depth.
[[nodiscard]] SurfacePoint nearest_surface(std::span<const ConvexPart> parts,
                                           const Eigen::Vector2d& point);

/// Support function: max of direction · p over the part; infinite if that is unbounded.
[[nodiscard]] double support(const ConvexPart& part, const Eigen::Vector2d& direction);

/// A disc that contains a part.
struct Circle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;  ///< infinite for a half-plane
};
[[nodiscard]] Circle circle_about(const ConvexPart& part);

/// Where a Gaussian's mean is relative to a part, in standard deviations.
struct PlanarSeparation {
  double z = 0.0;         ///< max over unit vectors n of (n·mean − support(n)) / √(nᵀ S n)
  Eigen::Vector2d slope;  ///< ∂z/∂mean = n / √(nᵀ S n) there
};

/// `covariance` must be positive definite. Inside, z < 0, and −z is the least number of deviations
/// out of the part among the directions that a few Newton steps find.
[[nodiscard]] PlanarSeparation separation(const ConvexPart& part, const Eigen::Vector2d& mean,
                                          const Eigen::Matrix2d& covariance);

}  // namespace qsmpc::controller
