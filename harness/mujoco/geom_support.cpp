#include "harness/mujoco/geom_support.hpp"

#include <algorithm>
#include <cmath>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

Eigen::Vector3d triple_at(const double* values, int element) {
  return Eigen::Map<const Eigen::Vector3d>(values + std::ptrdiff_t{3} * element);
}

/// Support of a mesh, in its own axes.
double mesh_support(const mjModel& model, int mesh, const Eigen::Vector3d& direction) {
  double most = -kInfinity;
  for (int v = 0; v < model.mesh_vertnum[mesh]; ++v) {
    const float* vertex = model.mesh_vert + std::ptrdiff_t{3} * (model.mesh_vertadr[mesh] + v);
    most = std::max(most, direction.dot(Eigen::Map<const Eigen::Vector3f>(vertex).cast<double>()));
  }
  return most;
}

/// Support of a geom about its centre, in its own axes.
double shape_support(const mjModel& model, int geom, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d size = triple_at(model.geom_size, geom);
  const double across = direction.head<2>().norm();
  const double along = std::abs(direction.z());
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return size[0] * direction.norm();
    case mjGEOM_CAPSULE:
      return size[1] * along + size[0] * direction.norm();
    case mjGEOM_CYLINDER:
      return size[1] * along + size[0] * across;
    case mjGEOM_ELLIPSOID:
      return size.cwiseProduct(direction).norm();
    case mjGEOM_MESH:
      return mesh_support(model, model.geom_dataid[geom], direction);
    default:
      return size.dot(direction.cwiseAbs());
  }
}

}  // namespace

GeomSupport geom_support(const mjModel& model, const mjData& data, int geom) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Vector3d centre = triple_at(data.geom_xpos, geom);
  const Eigen::Matrix3d to_geom =
      Eigen::Map<const RowMajor>(data.geom_xmat + std::ptrdiff_t{9} * geom).transpose();
  return [&model, geom, centre, to_geom](const Eigen::Vector3d& direction) {
    return direction.dot(centre) + shape_support(model, geom, to_geom * direction);
  };
}

}  // namespace qsmpc::harness
