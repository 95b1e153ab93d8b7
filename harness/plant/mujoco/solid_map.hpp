// Walls and obstacles of the safe set as geoms in a vehicle's MuJoCo model. Private to the MuJoCo
// plant.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "controller/regions/safe_set.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/mujoco/named_model.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Contents of an XML's sections.
struct Solids {
  std::string assets;  ///< meshes
  std::string geoms;   ///< of the worldbody
};

/// A plane for each bound of x and y and each half-plane, and a tall solid for each other obstacle
/// that restricts x and y only: boxes, cylinders, and a prism for each convex part of ellipses and
/// polygons. A box that is unbounded on a side ends 1 km away. Geoms of moving obstacles are on
/// mocap bodies. All geoms are created with collisions disabled.
[[nodiscard]] Solids solids_of(const controller::SafeSet& safe_set,
                               const models::SystemDescription& system);

/// The model of the file `mjcf` with the geoms of `safe_set` added, and room for their contacts. If
/// the model disables contacts, they are enabled for these geoms only. Throws InputError as
/// load_mujoco_model, and on a model that takes its contacts from listed pairs only.
[[nodiscard]] MujocoModelPtr load_with_solids(const std::string& mjcf,
                                              const controller::SafeSet& safe_set,
                                              const models::SystemDescription& system);

/// The geoms that load_with_solids added to a model.
class SolidMap {
 public:
  /// `carrier`: a body of the vehicle, all of whose bodies share its root. Throws InputError where
  /// the model's contact filters have no spare bit.
  SolidMap(const NamedModel& named, int carrier);

  /// Whether the vehicle collides with the geoms; initially it does not. Its other contacts are
  /// unaffected.
  void set_standing(mjModel& model, bool standing) const;
  /// Moves the bodies of moving obstacles to `poses`, as for Plant::move_obstacles.
  void place(const Eigen::Matrix3Xd& poses, const mjModel& model, mjData& data) const;
  /// N, the largest normal force between a solid geom and the vehicle; 0 without contact. data: of
  /// the model, after a step or mj_forward.
  [[nodiscard]] double largest_force(const mjModel& model, const mjData& data) const;

 private:
  int bit_ = 0;  // of contype and conaffinity
  std::vector<int> solids_;
  std::vector<int> moving_;     // bodies
  std::vector<int> vehicle_;    // geoms
  std::vector<char> is_solid_;  // by geom
};

}  // namespace qsmpc::harness
