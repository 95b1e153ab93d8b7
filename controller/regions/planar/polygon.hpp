// Polygons of the plane: whether they are ones, and what convex polygons they are made of.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/planar_shape.hpp"

namespace qsmpc::controller {

/// The same corners, counterclockwise.
[[nodiscard]] Eigen::Matrix2Xd counterclockwise(const Eigen::Matrix2Xd& corners);

/// The faces of a convex polygon of at least 3 corners, counterclockwise. Corners in which it goes
/// straight on are left out.
[[nodiscard]] ConvexPart convex_polygon(const Eigen::Matrix2Xd& corners);

/// The least convex polygon that holds the points, of which three are not on a line (Andrew 1979).
[[nodiscard]] ConvexPart convex_hull(const Eigen::Matrix2Xd& points);

/// Convex polygons, counterclockwise, whose union is the polygon, and that share edges alone: the
/// polygon cut into triangles by its ears, and triangles joined where the result is convex (Hertel
/// and Mehlhorn 1983: at most four times as many as the least possible).
[[nodiscard]] std::vector<Eigen::Matrix2Xd> convex_pieces(const Eigen::Matrix2Xd& corners);

}  // namespace qsmpc::controller
