// Lookup of MuJoCo model elements by name, and the geometry that the low-level loops need. For
// sources that work on MuJoCo models: unlike most headers here, it exposes MuJoCo's types.
#pragma once

#include <string>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace qsmpc::harness {

/// A model and its file name for errors.
struct NamedModel {
  const mjModel& model;
  std::string file;
};

/// Index of the element of `type` called `name`. Throws InputError, listing the existing ones.
[[nodiscard]] int element_index(const NamedModel& named, mjtObj type, const std::string& name);

/// Index of the slide or hinge joint called `name`. Throws InputError on any other joint.
[[nodiscard]] int scalar_joint(const NamedModel& named, const std::string& name);

/// Radius (m) of the wheel that spins about `joint`: that of the largest round geom of its body and
/// of the bodies fixed to it. Throws InputError where there is none.
[[nodiscard]] double wheel_radius(const NamedModel& named, int joint);

/// Orientation of a body in the world. data: with positions up to date.
[[nodiscard]] Eigen::Matrix3d body_rotation(const mjData& data, int body);

/// Origin of a body in the world, m.
[[nodiscard]] Eigen::Vector3d body_origin(const mjData& data, int body);

/// Anchor of a joint in the axes of `body`, m.
[[nodiscard]] Eigen::Vector3d anchor_in_body(const mjData& data, int joint, int body);

}  // namespace qsmpc::harness
