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

/// The insides of an XML's sections.
struct Solids {
  std::string assets;  ///< meshes
  std::string geoms;   ///< of the worldbody
};

/// A plane for each bound of x and y and each half-plane, and a solid as high as a house for each
/// other obstacle that restricts these two alone: boxes, cylinders, and a prism for each convex
/// part of ellipses and polygons. A box that is not bounded on a side ends 1 km away. Those of
/// obstacles that move are on mocap bodies. They collide with nothing yet.
[[nodiscard]] Solids solids_of(const controller::SafeSet& safe_set,
                               const models::SystemDescription& system);

/// The model of the file `mjcf` with the geoms of `safe_set` in it, and room for their contacts.
/// Contacts of a model that has them disabled are enabled, for these geoms only. Throws InputError
/// as load_mujoco_model, and on a model that takes its contacts from listed pairs only.
[[nodiscard]] MujocoModelPtr load_with_solids(const std::string& mjcf,
                                              const controller::SafeSet& safe_set,
                                              const models::SystemDescription& system);

/// The geoms of a model that was loaded with them.
class SolidMap {
 public:
  /// `carrier`: a body of the vehicle, which is all on the same root. Throws InputError where the
  /// model's contact filters have no bit to spare.
  SolidMap(const NamedModel& named, int carrier);

  /// Whether the vehicle can touch the geoms; at first it cannot. Its other contacts are the same.
  void set_standing(mjModel& model, bool standing) const;
  /// Puts the bodies of obstacles that move where they are: poses as Plant::move_obstacles takes
  /// them.
  void place(const Eigen::Matrix3Xd& poses, const mjModel& model, mjData& data) const;
  /// N, the largest normal force between one of them and the vehicle; 0 without contact. data: of
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
