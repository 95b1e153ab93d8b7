// Shapes in the plane of position, as they are specified, and their decomposition into convex
// parts.
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

// Lengths and positions in metres, angles in rad.

struct DiscShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;  ///< > 0
};

struct EllipseShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes = Eigen::Vector2d::Zero();  ///< both > 0
  double angle = 0.0;                                   ///< from the x axis to the first semi-axis
};

/// A rectangle that may be rotated.
struct TurnedBoxShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< full side lengths, both > 0
  double angle = 0.0;                              ///< from the x axis to the first side
};

/// A simple polygon (it neither crosses nor touches itself); it need not be convex.
struct PolygonShape {
  Eigen::Matrix2Xd corners;  ///< at least 3, in order, in either orientation
};

/// The points p with normal · p ≥ offset.
struct HalfPlaneShape {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< of any non-zero length
  double offset = 0.0;
};

using PlanarShape =
    std::variant<DiscShape, EllipseShape, TurnedBoxShape, PolygonShape, HalfPlaneShape>;

/// A closed convex set of the plane: all points within `radius` of a convex polygon. Without faces
/// it is a disc about its only corner; without corners, a half-plane.
struct ConvexPart {
  Eigen::Matrix2Xd corners;  ///< counterclockwise
  Eigen::Matrix2Xd normals;  ///< outward unit normals of the faces from each corner to the next
  Eigen::VectorXd offsets;   ///< normals.col(i) · p ≤ offsets[i] in the polygon
  double radius = 0.0;       ///< ≥ 0
};

/// Sides of the polygon that replaces an ellipse. The polygon circumscribes it, farther from its
/// centre by a fraction of at most 1/cos(π/kEllipseSides) − 1 < 0.00055.
inline constexpr int kEllipseSides = 96;

/// Throws std::invalid_argument, stating what is expected, on numbers that are not finite, sizes
/// that are not positive, and polygons that have no area or meet themselves.
void check_planar_shape(const PlanarShape& shape);

/// Parts whose union is the shape: a single one if it is convex. Those of a polygon that is not
/// convex share edges. `shape` must pass check_planar_shape.
[[nodiscard]] std::vector<ConvexPart> convex_parts(const PlanarShape& shape);

/// Why `corners` (in order) are not a simple polygon, as a statement of what is expected: at least
/// 3, finite, no zero area, no edges that meet. Empty if they are one.
[[nodiscard]] std::string why_no_polygon(const Eigen::Matrix2Xd& corners);

/// The corners of the outline for drawing, counterclockwise; a circle or an ellipse has `round`
/// sides. A half-plane is drawn as a rectangle that extends `far` metres.
[[nodiscard]] Eigen::Matrix2Xd shape_outline(const PlanarShape& shape, int round = 72,
                                             double far = 1e4);

/// The centre of the shape: the given one for a disc, an ellipse or a box; for a polygon, that of
/// its bounding rectangle; for a half-plane, the point of its edge that is nearest to the origin.
[[nodiscard]] Eigen::Vector2d shape_centre(const PlanarShape& shape);

/// The shape rotated about its centre by `turn` rad, then translated by `by`.
[[nodiscard]] PlanarShape moved(const PlanarShape& shape, const Eigen::Vector2d& by,
                                double turn = 0.0);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
