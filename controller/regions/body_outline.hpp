// The outline of the body in the plane, for drawing.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/regions/body.hpp"

namespace qsmpc::controller {

/// A circular arc, counterclockwise from one angle to another.
struct Arc {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m
  double radius = 0.0;                               ///< m
  double from = 0.0;                                 ///< rad
  double to = 0.0;                                   ///< rad, from < to ≤ from + 2π
};

/// The boundary of the union of the body's discs at `position` (m) and `heading` (rad): the arcs of
/// each disc that lie in no other disc. Empty for a point.
[[nodiscard]] std::vector<Arc> body_outline(const Body& body, const Eigen::Vector2d& position,
                                            double heading);

}  // namespace qsmpc::controller
