// Polygons in the plane: orientation, convex hulls and convex decomposition.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/planar_shape.hpp"

namespace qsmpc::controller {

/// The same corners, counterclockwise.
[[nodiscard]] Eigen::Matrix2Xd counterclockwise(const Eigen::Matrix2Xd& corners);

/// The faces of a convex polygon of at least 3 corners, counterclockwise. Corners without a turn
/// are left out.
[[nodiscard]] ConvexPart convex_polygon(const Eigen::Matrix2Xd& corners);

/// The convex hull of the points (Andrew 1979), at least three of which must not be collinear.
[[nodiscard]] ConvexPart convex_hull(const Eigen::Matrix2Xd& points);

/// Convex polygons, counterclockwise, whose union is the polygon and which share nothing but edges:
/// the polygon is triangulated by ear clipping, and triangles are merged where the result is convex
/// (Hertel and Mehlhorn 1983: at most four times the least possible number).
[[nodiscard]] std::vector<Eigen::Matrix2Xd> convex_pieces(const Eigen::Matrix2Xd& corners);

}  // namespace qsmpc::controller
