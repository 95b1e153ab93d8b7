// Elements of a loaded MuJoCo model by name, and geometry that the low-level loops take from it.
// For sources that work on MuJoCo models: it shows MuJoCo's types, as few headers here do.
#pragma once

#include <string>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace qsmpc::harness {

/// A model and what errors about it name.
struct NamedModel {
  const mjModel& model;
  std::string file;
};

/// Index of the element of `type` called `name`. Throws InputError that lists those which exist.
[[nodiscard]] int element_index(const NamedModel& named, mjtObj type, const std::string& name);

/// Index of the slide or hinge joint called `name`. Throws InputError on another one.
[[nodiscard]] int scalar_joint(const NamedModel& named, const std::string& name);

/// Radius (m) of the wheel that spins about `joint`: that of the largest round geom of its body and
/// of those fixed to it. Throws InputError where there is none.
[[nodiscard]] double wheel_radius(const NamedModel& named, int joint);

/// Orientation of a body in the world. data: with positions up to date.
[[nodiscard]] Eigen::Matrix3d body_rotation(const mjData& data, int body);

/// Origin of a body in the world, m.
[[nodiscard]] Eigen::Vector3d body_origin(const mjData& data, int body);

/// Anchor of a joint in the axes of `body`, m.
[[nodiscard]] Eigen::Vector3d anchor_in_body(const mjData& data, int joint, int body);

}  // namespace qsmpc::harness
