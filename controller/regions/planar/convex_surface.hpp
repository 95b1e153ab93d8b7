// Distances of points to convex parts, and the directions that separate them.
#pragma once

#include <span>

#include <Eigen/Core>

#include "controller/regions/planar/planar_shape.hpp"

namespace qsmpc::controller {

/// The surface of a part as seen from a point.
struct SurfacePoint {
  double distance = 0.0;  ///< less than 0 inside: minus the least distance that leads out
  Eigen::Vector2d outward = Eigen::Vector2d::UnitX();  ///< ∂distance/∂point, of length 1
};

[[nodiscard]] SurfacePoint nearest_surface(const ConvexPart& part, const Eigen::Vector2d& point);

/// Over several parts, of which one must be: the least distance. For a union this is the distance
/// outside of it, and inside at most the depth.
[[nodiscard]] SurfacePoint nearest_surface(std::span<const ConvexPart> parts,
                                           const Eigen::Vector2d& point);

/// max over the part of direction · p; infinite where it has no end.
[[nodiscard]] double support(const ConvexPart& part, const Eigen::Vector2d& direction);

/// A disc about the part.
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

/// `covariance` must be positive definite. Inside, z < 0 is the least number of deviations that
/// leads out, of the directions that a few Newton steps find.
[[nodiscard]] PlanarSeparation separation(const ConvexPart& part, const Eigen::Vector2d& mean,
                                          const Eigen::Matrix2d& covariance);

}  // namespace qsmpc::controller
