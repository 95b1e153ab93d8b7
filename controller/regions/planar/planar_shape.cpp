#include "controller/regions/planar/planar_shape.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>

#include "controller/regions/planar/polygon.hpp"

namespace qsmpc::controller {
namespace {

void require_shape(bool holds, const char* expected) {
  if (!holds) throw std::invalid_argument(expected);
}

struct ShapeCheck {
  void operator()(const DiscShape& disc) const {
    require_shape(disc.centre.allFinite(), "disc: a finite centre");
    require_shape(disc.radius > 0.0 && std::isfinite(disc.radius), "disc: a radius above 0");
  }
  void operator()(const EllipseShape& ellipse) const {
    require_shape(ellipse.centre.allFinite() && std::isfinite(ellipse.angle),
                  "ellipse: a finite centre and angle");
    require_shape((ellipse.semi_axes.array() > 0.0).all() && ellipse.semi_axes.allFinite(),
                  "ellipse: semi-axes above 0");
  }
  void operator()(const TurnedBoxShape& box) const {
    require_shape(box.centre.allFinite() && std::isfinite(box.angle),
                  "box: a finite centre and angle");
    require_shape((box.size.array() > 0.0).all() && box.size.allFinite(), "box: sides above 0");
  }
  void operator()(const PolygonShape& polygon) const {
    const std::string wrong = why_no_polygon(polygon.corners);
    if (!wrong.empty()) throw std::invalid_argument("polygon: " + wrong);
  }
  void operator()(const HalfPlaneShape& half_plane) const {
    require_shape(half_plane.normal.allFinite() && half_plane.normal.norm() > 0.0,
                  "half_plane: a finite normal with a length above 0");
    require_shape(std::isfinite(half_plane.offset), "half_plane: a finite offset");
  }
};

/// Corners of a regular polygon of `count` sides that circumscribes the unit circle.
Eigen::Matrix2Xd about_circle(int count) {
  const double reach = 1.0 / std::cos(std::numbers::pi / count);
  Eigen::Matrix2Xd corners(2, count);
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / count;
    corners.col(i) << reach * std::cos(angle), reach * std::sin(angle);
  }
  return corners;
}

Eigen::Matrix2Xd corners_of(const EllipseShape& ellipse, int count) {
  const Eigen::Matrix2d frame =
      Eigen::Rotation2Dd(ellipse.angle).toRotationMatrix() * ellipse.semi_axes.asDiagonal();
  return (frame * about_circle(count)).colwise() + ellipse.centre;
}

Eigen::Matrix2Xd corners_of(const TurnedBoxShape& box) {
  Eigen::Matrix2Xd corners(2, 4);
  corners << -0.5, 0.5, 0.5, -0.5, -0.5, -0.5, 0.5, 0.5;
  const Eigen::Matrix2d frame =
      Eigen::Rotation2Dd(box.angle).toRotationMatrix() * box.size.asDiagonal();
  return (frame * corners).colwise() + box.centre;
}

struct PartsOf {
  std::vector<ConvexPart> operator()(const DiscShape& disc) const {
    return {{.corners = disc.centre,
             .normals = Eigen::Matrix2Xd(2, 0),
             .offsets = Eigen::VectorXd(0),
             .radius = disc.radius}};
  }
  std::vector<ConvexPart> operator()(const EllipseShape& ellipse) const {
    return {convex_polygon(corners_of(ellipse, kEllipseSides))};
  }
  std::vector<ConvexPart> operator()(const TurnedBoxShape& box) const {
    return {convex_polygon(corners_of(box))};
  }
  std::vector<ConvexPart> operator()(const PolygonShape& polygon) const {
    std::vector<ConvexPart> parts;
    for (const Eigen::Matrix2Xd& corners : convex_pieces(polygon.corners)) {
      parts.push_back(convex_polygon(corners));
    }
    return parts;
  }
  std::vector<ConvexPart> operator()(const HalfPlaneShape& half_plane) const {
    const double length = half_plane.normal.norm();
    return {{.corners = Eigen::Matrix2Xd(2, 0),
             .normals = -half_plane.normal / length,
             .offsets = Eigen::VectorXd::Constant(1, -half_plane.offset / length)}};
  }
};

struct OutlineOf {
  int round;
  double far;

  Eigen::Matrix2Xd operator()(const DiscShape& disc) const {
    return corners_of(
        EllipseShape{.centre = disc.centre, .semi_axes = Eigen::Vector2d::Constant(disc.radius)},
        round);
  }
  Eigen::Matrix2Xd operator()(const EllipseShape& ellipse) const {
    return corners_of(ellipse, round);
  }
  Eigen::Matrix2Xd operator()(const TurnedBoxShape& box) const { return corners_of(box); }
  Eigen::Matrix2Xd operator()(const PolygonShape& polygon) const {
    return counterclockwise(polygon.corners);
  }
  Eigen::Matrix2Xd operator()(const HalfPlaneShape& half_plane) const {
    const Eigen::Vector2d into = half_plane.normal.normalized();
    const Eigen::Vector2d along(into.y(), -into.x());
    const Eigen::Vector2d edge = half_plane.offset / half_plane.normal.norm() * into;
    Eigen::Matrix2Xd corners(2, 4);
    corners << edge - far * along, edge - far * along + far * into, edge + far * along + far * into,
        edge + far * along;
    return counterclockwise(corners);
  }
};

struct CentreOf {
  Eigen::Vector2d operator()(const PolygonShape& polygon) const {
    return 0.5 * (polygon.corners.rowwise().minCoeff() + polygon.corners.rowwise().maxCoeff());
  }
  Eigen::Vector2d operator()(const HalfPlaneShape& half_plane) const {
    return half_plane.offset / half_plane.normal.squaredNorm() * half_plane.normal;
  }
  template <class Centred>
  Eigen::Vector2d operator()(const Centred& shape) const {
    return shape.centre;
  }
};

struct MovedBy {
  Eigen::Vector2d by;
  double turn;

  PlanarShape operator()(DiscShape disc) const {
    disc.centre += by;
    return disc;
  }
  PlanarShape operator()(PolygonShape polygon) const {
    const Eigen::Vector2d centre = CentreOf{}(polygon);
    const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(turn).toRotationMatrix();
    polygon.corners = (rotation * (polygon.corners.colwise() - centre)).colwise() + (centre + by);
    return polygon;
  }
  PlanarShape operator()(HalfPlaneShape half_plane) const {
    const Eigen::Vector2d edge = CentreOf{}(half_plane) + by;
    half_plane.normal = Eigen::Rotation2Dd(turn) * half_plane.normal;
    half_plane.offset = half_plane.normal.dot(edge);
    return half_plane;
  }
  template <class Centred>
  PlanarShape operator()(Centred shape) const {
    shape.centre += by;
    shape.angle += turn;
    return shape;
  }
};

}  // namespace

void check_planar_shape(const PlanarShape& shape) { std::visit(ShapeCheck{}, shape); }

std::vector<ConvexPart> convex_parts(const PlanarShape& shape) {
  return std::visit(PartsOf{}, shape);
}

Eigen::Matrix2Xd shape_outline(const PlanarShape& shape, int round, double far) {
  return std::visit(OutlineOf{.round = round, .far = far}, shape);
}

Eigen::Vector2d shape_centre(const PlanarShape& shape) { return std::visit(CentreOf{}, shape); }

PlanarShape moved(const PlanarShape& shape, const Eigen::Vector2d& by, double turn) {
  return std::visit(MovedBy{.by = by, .turn = turn}, shape);
}

}  // namespace qsmpc::controller
