#include "harness/mujoco/ground_geoms.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

#include "harness/mujoco/geom_support.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

using controller::PlanarShape;

constexpr double kUpright = 1e-9;  // of an axis: rounding of printed rotations
constexpr double kOutward = 1e-9;  // of a size: more than the rounding of corners

Eigen::Vector3d place_of(const double* values, int element) {
  return Eigen::Map<const Eigen::Vector3d>(values + std::ptrdiff_t{3} * element);
}

/// The pose of a geom: its axes are the columns.
struct GeomPose {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;
  Eigen::Vector3d size;

  /// The index of the vertical axis, or -1.
  [[nodiscard]] int upright() const {
    for (int i = 0; i < 3; ++i) {
      if (axes.col(i).head<2>().norm() <= kUpright) return i;
    }
    return -1;
  }
};

GeomPose pose_of(const mjModel& model, const mjData& data, int geom) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return {.centre = place_of(data.geom_xpos, geom),
          .axes = Eigen::Map<const RowMajor>(data.geom_xmat + std::ptrdiff_t{9} * geom),
          .size = place_of(model.geom_size, geom)};
}

/// Positive where the path from a over b to c turns left.
double turn_at(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - b).y() - (b - a).y() * (c - b).x();
}

/// The corners of the convex hull, counterclockwise (Andrew's monotone chain).
std::vector<Eigen::Vector2d> hull_of(std::vector<Eigen::Vector2d> points) {
  std::ranges::sort(points, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2d> hull;
  const auto chain = [&hull](const std::vector<Eigen::Vector2d>& way) {
    const std::size_t start = hull.size();
    for (const Eigen::Vector2d& point : way) {
      while (hull.size() >= start + 2 && turn_at(hull[hull.size() - 2], hull.back(), point) <= 0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();  // the next chain begins there
  };
  chain(points);
  std::ranges::reverse(points);
  chain(points);
  return hull;
}

controller::PolygonShape polygon_of(const std::vector<Eigen::Vector2d>& corners) {
  controller::PolygonShape polygon{.corners = Eigen::Matrix2Xd(2, std::ssize(corners))};
  Eigen::Index i = 0;
  for (const Eigen::Vector2d& corner : corners) polygon.corners.col(i++) = corner;
  return polygon;
}

/// The polygon whose sides touch the projection in kProjectionSides directions.
PlanarShape polygon_about(const GeomSupport& support) {
  constexpr double kStep = 2.0 * std::numbers::pi / kProjectionSides;
  const auto direction = [](int k) {
    return Eigen::Vector2d(std::cos(kStep * k), std::sin(kStep * k));
  };
  const auto reach = [&](int k) {
    const Eigen::Vector2d d = direction(k);
    return support({d.x(), d.y(), 0.0});
  };
  const double size = std::max(reach(0) + reach(kProjectionSides / 2),
                               reach(kProjectionSides / 4) + reach(3 * kProjectionSides / 4));
  std::vector<Eigen::Vector2d> corners;
  for (int k = 0; k < kProjectionSides; ++k) {
    Eigen::Matrix2d sides;
    sides << direction(k).transpose(), direction(k + 1).transpose();
    const Eigen::Vector2d reaches(reach(k), reach(k + 1));
    corners.emplace_back(sides.inverse() * (reaches + Eigen::Vector2d::Constant(kOutward * size)));
  }
  return polygon_of(hull_of(std::move(corners)));
}

/// The hull of the points' projections.
PlanarShape projected_hull(const std::vector<Eigen::Vector2d>& points, const GeomSupport& support) {
  const std::vector<Eigen::Vector2d> corners = hull_of(points);
  return corners.size() > kProjectionSides ? polygon_about(support) : polygon_of(corners);
}

PlanarShape projected_box(const GeomPose& pose, const GeomSupport& support) {
  const int up = pose.upright();
  if (up >= 0) {
    const int first = (up + 1) % 3;
    const int second = (up + 2) % 3;
    return controller::TurnedBoxShape{
        .centre = pose.centre.head<2>(),
        .size = 2.0 * Eigen::Vector2d(pose.size[first], pose.size[second]),
        .angle = std::atan2(pose.axes(1, first), pose.axes(0, first))};
  }
  std::vector<Eigen::Vector2d> corners;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d signs((k & 1) == 0 ? -1 : 1, (k & 2) == 0 ? -1 : 1,
                                (k & 4) == 0 ? -1 : 1);
    corners.emplace_back((pose.centre + pose.axes * pose.size.cwiseProduct(signs)).head<2>());
  }
  return projected_hull(corners, support);
}

/// The projection of an ellipsoid is an ellipse: its matrix is a block of the ellipsoid's matrix.
PlanarShape projected_ellipsoid(const GeomPose& pose) {
  const Eigen::Matrix3d frame = pose.axes * pose.size.asDiagonal();
  const Eigen::Matrix2d block = (frame * frame.transpose()).topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(block);
  const Eigen::Vector2d first = axes.eigenvectors().col(1);
  return controller::EllipseShape{.centre = pose.centre.head<2>(),
                                  .semi_axes = axes.eigenvalues().reverse().cwiseSqrt(),
                                  .angle = std::atan2(first.y(), first.x())};
}

PlanarShape projected_mesh(const mjModel& model, int geom, const GeomPose& pose,
                           const GeomSupport& support) {
  const int mesh = model.geom_dataid[geom];
  std::vector<Eigen::Vector2d> points;
  for (int v = 0; v < model.mesh_vertnum[mesh]; ++v) {
    const float* vertex = model.mesh_vert + std::ptrdiff_t{3} * (model.mesh_vertadr[mesh] + v);
    const Eigen::Vector3d own = Eigen::Map<const Eigen::Vector3f>(vertex).cast<double>();
    points.emplace_back((pose.centre + pose.axes * own).head<2>());
  }
  return projected_hull(points, support);
}

/// The half-space behind a plane is unsafe.
void add_plane(GroundGeom& geom, const GeomPose& pose) {
  const Eigen::Vector3d normal = pose.axes.col(2);
  geom.lowest = -kInfinity;
  geom.highest = kInfinity;
  if (pose.upright() == 2) {
    geom.is_ground = true;
    geom.highest = pose.centre.z();
    geom.why_none = "a level plane";
  } else if (std::abs(normal.z()) > kUpright) {
    geom.why_none = "a tilted plane";
  } else {
    geom.shape = controller::HalfPlaneShape{.normal = -normal.head<2>(),
                                            .offset = -normal.head<2>().dot(pose.centre.head<2>())};
  }
}

std::optional<PlanarShape> projection_of(const mjModel& model, int geom, const GeomPose& pose,
                                         const GeomSupport& support) {
  const controller::DiscShape disc{.centre = pose.centre.head<2>(), .radius = pose.size[0]};
  switch (model.geom_type[geom]) {
    case mjGEOM_BOX:
      return projected_box(pose, support);
    case mjGEOM_SPHERE:
      return disc;
    case mjGEOM_CAPSULE:
    case mjGEOM_CYLINDER:
      if (pose.upright() == 2) return disc;
      return polygon_about(support);
    case mjGEOM_ELLIPSOID:
      return projected_ellipsoid(pose);
    case mjGEOM_MESH:
      return projected_mesh(model, geom, pose, support);
    default:
      return std::nullopt;
  }
}

/// Whether a joint or a mocap body carries the body, directly or indirectly.
bool moves(const mjModel& model, int body) {
  for (; body > 0; body = model.body_parentid[body]) {
    if (model.body_jntnum[body] > 0 || model.body_mocapid[body] >= 0) return true;
  }
  return false;
}

GroundGeom ground_geom(const mjModel& model, const mjData& data, int geom) {
  GroundGeom found{.name = model.names + model.name_geomadr[geom],
                   .group = model.geom_group[geom],
                   .is_static = !moves(model, model.geom_bodyid[geom])};
  const GeomPose pose = pose_of(model, data, geom);
  if (model.geom_type[geom] == mjGEOM_PLANE) {
    add_plane(found, pose);
    return found;
  }
  const GeomSupport support = geom_support(model, data, geom);
  found.lowest = -support(-Eigen::Vector3d::UnitZ());
  found.highest = support(Eigen::Vector3d::UnitZ());
  found.shape = projection_of(model, geom, pose, support);
  if (!found.shape) found.why_none = "a height field";
  return found;
}

}  // namespace

std::vector<GroundGeom> ground_geoms(const mjModel_& model) {
  const MujocoTrap trap;
  const auto deleter = [](mjData* data) { mj_deleteData(data); };
  const std::unique_ptr<mjData, decltype(deleter)> data(mj_makeData(&model), deleter);
  mj_kinematics(&model, data.get());
  std::vector<GroundGeom> geoms;
  geoms.reserve(static_cast<std::size_t>(model.ngeom));
  for (int geom = 0; geom < model.ngeom; ++geom) {
    geoms.push_back(ground_geom(model, *data, geom));
  }
  return geoms;
}

}  // namespace qsmpc::harness
