// The visible shapes of a MuJoCo model and the poses of its moving parts, as plain values for
// rendering elsewhere.
//
//   VehicleShapes vehicle("dubins_car.xml");
//   vehicle.shapes();                      // once
//   vehicle.parts(sample.qpos);            // of every moment
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "harness/mujoco/mujoco_model.hpp"

namespace qsmpc::harness {

enum class ShapeKind {
  kBox,        ///< size: half sides
  kEllipsoid,  ///< size: half axes
  kCapsule,    ///< along z; size: radius, half length without the caps
  kCylinder,   ///< along z; size: radius, half length
  kMesh        ///< triangles
};

/// A position (m) and an orientation, in some frame.
struct Placement {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

struct VehicleShape {
  static constexpr int kWorld = -1;

  ShapeKind kind = ShapeKind::kBox;
  int part = kWorld;  ///< that it is fixed to: kWorld, or the index of a moving part
  int mesh = -1;      ///< of kMesh: its index among the meshes
  std::array<double, 3> size{};
  Placement place{};  ///< in the axes of its part
  std::array<double, 4> rgba{};
};

struct VehicleMesh {
  std::vector<double> vertices;          ///< m, three per vertex, in the axes of the shape
  std::vector<std::uint32_t> triangles;  ///< three vertices each, anticlockwise from outside
};

class VehicleShapes {
 public:
  /// Limit for all meshes and height fields of a model together, and for each. Larger ones become
  /// boxes.
  static constexpr std::size_t kMostTriangles = 30'000;
  static constexpr std::size_t kMostVertices = 65'535;

  /// Loads the MJCF file `path`. Visible geoms are those that MuJoCo shows by default (groups 0 to
  /// 2), without planes and fully transparent geoms. Throws InputError as load_mujoco_model.
  explicit VehicleShapes(const std::string& path);
  ~VehicleShapes();
  VehicleShapes(const VehicleShapes&) = delete;
  VehicleShapes& operator=(const VehicleShapes&) = delete;

  [[nodiscard]] const std::vector<VehicleShape>& shapes() const { return shapes_; }
  [[nodiscard]] const std::vector<VehicleMesh>& meshes() const { return meshes_; }
  /// The number of meshes and height fields with too many triangles, which are boxes instead.
  [[nodiscard]] int boxed() const { return boxed_; }

  /// The number of moving parts. Bodies without joints between them are one part.
  [[nodiscard]] std::size_t part_count() const { return bodies_.size(); }
  /// The size of `qpos`.
  [[nodiscard]] std::size_t coordinate_count() const;

  /// The poses of the moving parts in the world. Throws std::invalid_argument unless `qpos` has
  /// coordinate_count() finite values.
  [[nodiscard]] std::vector<Placement> parts(std::span<const double> qpos);

  /// The same with the vehicle at the origin, heading along x: the first free joint is placed there
  /// (without one: the first joints that slide along x and y and turn about z), all other joints
  /// are at the model's reference pose.
  [[nodiscard]] std::vector<Placement> parts_at_origin();

 private:
  struct Simulator;

  void add_shapes();
  void add_mesh(VehicleShape& shape, int mesh);
  void add_height_field(VehicleShape& shape, int field);
  void add_triangles(VehicleShape& shape, int source, VehicleMesh mesh);
  [[nodiscard]] int part_of(int body);

  std::unique_ptr<Simulator> simulator_;
  std::vector<VehicleShape> shapes_;
  std::vector<VehicleMesh> meshes_;
  std::vector<int> mesh_sources_;  // MuJoCo's index of each; negative for height fields
  std::vector<int> bodies_;        // of each part
  std::size_t triangles_ = 0;
  int boxed_ = 0;
};

}  // namespace qsmpc::harness
