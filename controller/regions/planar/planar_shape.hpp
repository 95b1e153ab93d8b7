// Shapes in the plane of position, as they are written, and the convex parts that they are made of.
//
//   const PlanarShape pillar = DiscShape{.centre = {3, 4}, .radius = 0.5};
//   for (const ConvexPart& part : convex_parts(pillar)) …
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

// Lengths and places in metres, angles in rad.

struct DiscShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;  ///< > 0
};

struct EllipseShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes = Eigen::Vector2d::Zero();  ///< both > 0
  double angle = 0.0;                                   ///< from the x axis to the first semi-axis
};

/// A rectangle that may be turned.
struct TurnedBoxShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< whole sides, both > 0
  double angle = 0.0;                              ///< from the x axis to the first side
};

/// A polygon that does not meet itself; it need not be convex.
struct PolygonShape {
  Eigen::Matrix2Xd corners;  ///< at least 3, in turn, either way round
};

/// The points p with normal · p ≥ offset.
struct HalfPlaneShape {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< of any length but 0
  double offset = 0.0;
};

using PlanarShape =
    std::variant<DiscShape, EllipseShape, TurnedBoxShape, PolygonShape, HalfPlaneShape>;

/// A closed convex set of the plane: a convex polygon, and all that is within `radius` of it. Where
/// it has no face it is a disc about its only corner; where it has no corner, a half-plane.
struct ConvexPart {
  Eigen::Matrix2Xd corners;  ///< counterclockwise
  Eigen::Matrix2Xd normals;  ///< outward, of length 1: of the faces from each corner to the next
  Eigen::VectorXd offsets;   ///< normals.col(i) · p ≤ offsets[i] in the polygon
  double radius = 0.0;       ///< ≥ 0
};

/// Sides of the polygon that an ellipse is taken for. It lies about the ellipse, farther from its
/// centre by less than the share 1/cos(π/kEllipseSides) − 1 = 0.00055.
inline constexpr int kEllipseSides = 96;

/// Throws std::invalid_argument, saying what is expected, on numbers that are not finite, sizes
/// that are not positive, and polygons that have no area or meet themselves.
void check_planar_shape(const PlanarShape& shape);

/// Parts whose union is the shape: one where it is convex. Of a polygon that is not, they share
/// edges. `shape` must be one that check_planar_shape takes.
[[nodiscard]] std::vector<ConvexPart> convex_parts(const PlanarShape& shape);

/// Where the polygon of `corners` (at least 3, in turn) meets itself or is flat; empty where it is
/// a polygon.
[[nodiscard]] std::string why_no_polygon(const Eigen::Matrix2Xd& corners);

/// The outline for drawing, counterclockwise: the corners, arcs as `round` chords to a turn. A
/// half-plane has four, far away ones being infinite only by size: it reaches `far` metres.
[[nodiscard]] Eigen::Matrix2Xd shape_outline(const PlanarShape& shape, int round = 72,
                                             double far = 1e4);

/// Its middle: what a disc, an ellipse and a box are written about, of a polygon that of the
/// rectangle about it, of a half-plane the point of the edge that is nearest to the origin.
[[nodiscard]] Eigen::Vector2d shape_centre(const PlanarShape& shape);

/// The shape turned about its centre by `turn` rad, and then moved by `by`.
[[nodiscard]] PlanarShape moved(const PlanarShape& shape, const Eigen::Vector2d& by,
                                double turn = 0.0);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
