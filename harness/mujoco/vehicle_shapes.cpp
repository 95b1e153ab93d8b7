#include "harness/mujoco/vehicle_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "harness/mujoco/mujoco_errors.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kLastVisibleGroup = 2;  // of the groups that mjvOption shows by default
constexpr double kAlongAxis = 1e-6;   // of an axis
constexpr std::array<float, 4> kColourOfNone{0.5F, 0.5F, 0.5F, 1.0F};

using Data = std::unique_ptr<mjData, void (*)(mjData*)>;

Eigen::Vector3d three_at(const double* values, int element) {
  return Eigen::Map<const Eigen::Vector3d>(values + std::ptrdiff_t{3} * element);
}

Eigen::Quaterniond four_at(const double* values, int element) {
  const double* q = values + std::ptrdiff_t{4} * element;
  return {q[0], q[1], q[2], q[3]};
}

Placement body_place(const mjData& data, int body) {
  return {three_at(data.xpos, body), four_at(data.xquat, body)};
}

Placement geom_place(const mjModel& model, const mjData& data, int geom) {
  const Placement body = body_place(data, model.geom_bodyid[geom]);
  return {three_at(data.geom_xpos, geom), body.rotation * four_at(model.geom_quat, geom)};
}

/// The pose `inner`, given in the world, relative to `outer`.
Placement seen_from(const Placement& outer, const Placement& inner) {
  const Eigen::Quaterniond back = outer.rotation.conjugate();
  return {back * (inner.position - outer.position), (back * inner.rotation).normalized()};
}

/// As MuJoCo draws it: the material's colour, unless the geom has its own.
std::array<double, 4> colour_of(const mjModel& model, int geom) {
  const float* own = model.geom_rgba + std::ptrdiff_t{4} * geom;
  const int material = model.geom_matid[geom];
  const bool has_own = !std::equal(kColourOfNone.begin(), kColourOfNone.end(), own);
  const float* rgba = has_own || material < 0 ? own : model.mat_rgba + std::ptrdiff_t{4} * material;
  std::array<double, 4> colour{};
  std::copy_n(rgba, colour.size(), colour.begin());
  return colour;
}

/// Address in qpos of the first joint of `type` along or about `axis`, or -1.
int joint_address(const mjModel& model, int type, int axis) {
  for (int joint = 0; joint < model.njnt; ++joint) {
    const double along = three_at(model.jnt_axis, joint)[axis];
    if (model.jnt_type[joint] == type && std::abs(along - 1.0) < kAlongAxis) {
      return model.jnt_qposadr[joint];
    }
  }
  return -1;
}

void set_at_origin(const mjModel& model, double* qpos) {
  for (int joint = 0; joint < model.njnt; ++joint) {
    if (model.jnt_type[joint] != mjJNT_FREE) continue;
    double* const free = qpos + model.jnt_qposadr[joint];
    free[0] = 0.0;
    free[1] = 0.0;
    free[3] = 1.0;
    std::fill_n(free + 4, 3, 0.0);
    return;
  }
  for (const int address :
       {joint_address(model, mjJNT_SLIDE, 0), joint_address(model, mjJNT_SLIDE, 1),
        joint_address(model, mjJNT_HINGE, 2)}) {
    if (address >= 0) qpos[address] = 0.0;
  }
}

/// Replaces a mesh by its bounding box.
void make_box(VehicleShape& shape, const VehicleMesh& mesh) {
  const Eigen::Map<const Eigen::Matrix3Xd> vertices(
      mesh.vertices.data(), 3, static_cast<Eigen::Index>(mesh.vertices.size() / 3));
  const Eigen::Vector3d lower = vertices.rowwise().minCoeff();
  const Eigen::Vector3d upper = vertices.rowwise().maxCoeff();
  shape.kind = ShapeKind::kBox;
  shape.place.position += shape.place.rotation * (0.5 * (lower + upper));
  for (int i = 0; i < 3; ++i) shape.size[static_cast<std::size_t>(i)] = 0.5 * (upper - lower)[i];
}

}  // namespace

struct VehicleShapes::Simulator {
  explicit Simulator(const std::string& path)
      : model(load_mujoco_model(path)), data(mj_makeData(model.get()), mj_deleteData) {}

  void update() {
    const MujocoTrap trap;
    mj_kinematics(model.get(), data.get());
  }

  MujocoModelPtr model;
  Data data;
};

VehicleShapes::VehicleShapes(const std::string& path)
    : simulator_(std::make_unique<Simulator>(path)) {
  simulator_->update();
  add_shapes();
}

VehicleShapes::~VehicleShapes() = default;

std::size_t VehicleShapes::coordinate_count() const {
  return static_cast<std::size_t>(simulator_->model->nq);
}

/// The part of `body`, by way of the body that it is fixed to; created with its first shape.
int VehicleShapes::part_of(int body) {
  const int carrier = simulator_->model->body_weldid[body];
  if (carrier == 0) return VehicleShape::kWorld;
  const auto known = std::ranges::find(bodies_, carrier);
  const auto index = static_cast<int>(known - bodies_.begin());
  if (known == bodies_.end()) bodies_.push_back(carrier);
  return index;
}

void VehicleShapes::add_shapes() {
  const mjModel& model = *simulator_->model;
  const mjData& data = *simulator_->data;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const int type = model.geom_type[geom];
    const std::array<double, 4> rgba = colour_of(model, geom);
    const bool hidden = model.geom_group[geom] > kLastVisibleGroup || rgba[3] <= 0.0;
    if (hidden || type == mjGEOM_PLANE) continue;
    VehicleShape shape{.part = part_of(model.geom_bodyid[geom]), .rgba = rgba};
    const int carrier = shape.part < 0 ? 0 : bodies_[static_cast<std::size_t>(shape.part)];
    shape.place = seen_from(body_place(data, carrier), geom_place(model, data, geom));
    const Eigen::Vector3d size = three_at(model.geom_size, geom);
    shape.size = {size[0], size[1], size[2]};
    switch (type) {
      case mjGEOM_SPHERE:
        shape.size = {size[0], size[0], size[0]};
        [[fallthrough]];
      case mjGEOM_ELLIPSOID:
        shape.kind = ShapeKind::kEllipsoid;
        break;
      case mjGEOM_CAPSULE:
        shape.kind = ShapeKind::kCapsule;
        break;
      case mjGEOM_CYLINDER:
        shape.kind = ShapeKind::kCylinder;
        break;
      case mjGEOM_MESH:
        add_mesh(shape, model.geom_dataid[geom]);
        break;
      case mjGEOM_HFIELD:
        add_height_field(shape, model.geom_dataid[geom]);
        break;
      default:
        break;
    }
    shapes_.push_back(shape);
  }
}

void VehicleShapes::add_mesh(VehicleShape& shape, int mesh) {
  const mjModel& model = *simulator_->model;
  VehicleMesh triangles;
  const float* vertex = model.mesh_vert + std::ptrdiff_t{3} * model.mesh_vertadr[mesh];
  triangles.vertices.assign(vertex, vertex + std::ptrdiff_t{3} * model.mesh_vertnum[mesh]);
  const int* corner = model.mesh_face + std::ptrdiff_t{3} * model.mesh_faceadr[mesh];
  triangles.triangles.assign(corner, corner + std::ptrdiff_t{3} * model.mesh_facenum[mesh]);
  add_triangles(shape, mesh, std::move(triangles));
}

/// Adds the upper surface of a height field.
void VehicleShapes::add_height_field(VehicleShape& shape, int field) {
  const mjModel& model = *simulator_->model;
  const double* size = model.hfield_size + std::ptrdiff_t{4} * field;
  const float* height = model.hfield_data + model.hfield_adr[field];
  const auto rows = static_cast<std::uint32_t>(model.hfield_nrow[field]);
  const auto columns = static_cast<std::uint32_t>(model.hfield_ncol[field]);
  VehicleMesh mesh;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const auto share = [](std::uint32_t i, std::uint32_t count) {
        return 2.0 * i / (count - 1.0) - 1.0;
      };
      const double z = size[2] * static_cast<double>(height[row * columns + column]);
      mesh.vertices.insert(mesh.vertices.end(),
                           {size[0] * share(column, columns), size[1] * share(row, rows), z});
      if (row == 0 || column == 0) continue;
      const std::uint32_t far = row * columns + column;
      const std::uint32_t near = far - columns;
      mesh.triangles.insert(mesh.triangles.end(), {near - 1, near, far, near - 1, far, far - 1});
    }
  }
  add_triangles(shape, -1 - field, std::move(mesh));
}

void VehicleShapes::add_triangles(VehicleShape& shape, int source, VehicleMesh mesh) {
  const auto known = std::ranges::find(mesh_sources_, source);
  shape.kind = ShapeKind::kMesh;
  shape.mesh = static_cast<int>(known - mesh_sources_.begin());
  if (known != mesh_sources_.end()) return;
  if (triangles_ + mesh.triangles.size() / 3 > kMostTriangles ||
      mesh.vertices.size() / 3 > kMostVertices) {
    shape.mesh = -1;
    make_box(shape, mesh);
    ++boxed_;
    return;
  }
  triangles_ += mesh.triangles.size() / 3;
  mesh_sources_.push_back(source);
  meshes_.push_back(std::move(mesh));
}

std::vector<Placement> VehicleShapes::parts(std::span<const double> qpos) {
  const bool finite = std::ranges::all_of(qpos, [](double value) { return std::isfinite(value); });
  if (qpos.size() != coordinate_count() || !finite) {
    throw std::invalid_argument(
        fmt::format("vehicle: qpos must have {} finite values", coordinate_count()));
  }
  std::ranges::copy(qpos, simulator_->data->qpos);
  simulator_->update();
  std::vector<Placement> places;
  places.reserve(bodies_.size());
  for (const int body : bodies_) places.push_back(body_place(*simulator_->data, body));
  return places;
}

std::vector<Placement> VehicleShapes::parts_at_origin() {
  const mjModel& model = *simulator_->model;
  std::vector<double> qpos(model.qpos0, model.qpos0 + model.nq);
  set_at_origin(model, qpos.data());
  return parts(qpos);
}

}  // namespace qsmpc::harness
