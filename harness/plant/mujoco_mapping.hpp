// How a system's states and inputs appear in a MuJoCo model, as plain values: elements by name, no
// numbers that the model itself holds. mujoco_binding.hpp resolves them in a loaded model.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

/// A planar pose read from a free joint: which states are x (m), y (m) and heading (rad,
/// unwrapped).
struct FreeJointPose {
  std::string joint;
  int x = 0;
  int y = 1;
  int heading = 2;
};

/// A wheel that is steered about a joint by a servo whose control is the angle (rad).
struct SteeredWheel {
  std::string joint;
  std::string actuator;
};

/// Low-level loop: the input `yaw_rate` (rad/s) becomes the steering angle of each steered wheel at
/// which it rolls without slip while the car moves at `speed` about the middle of the fixed axle.
struct AckermannSteering {
  int yaw_rate = 0;
  double speed = 0.0;                   ///< m/s, > 0
  std::vector<SteeredWheel> wheels;     ///< at least one
  std::vector<std::string> fixed_axle;  ///< joints of the unsteered wheels, at least one
};

/// Low-level loop: the velocity servo `actuator` (rad/s) holds the driven wheels at the angular
/// velocity of `speed`.
struct SpeedHold {
  double speed = 0.0;  ///< m/s, > 0
  std::string actuator;
  std::vector<std::string> wheels;  ///< joints of all rolling wheels, a driven one first
};

using LowLevelLoop = std::variant<AckermannSteering, SpeedHold>;

struct MujocoMapping {
  FreeJointPose pose;
  std::vector<LowLevelLoop> loops;
  int input_dim = 1;
};

/// The mapping of the Dubins car to a car named as in models/mjcf/dubins_car.xml.
/// speed: m/s, > 0.
[[nodiscard]] MujocoMapping dubins_car_mapping(double speed);

/// The mapping of the system called `system` with all its `parameters`.
/// Throws InputError on a system for which there is no MuJoCo vehicle, or on a speed that none can
/// hold.
[[nodiscard]] MujocoMapping mujoco_mapping(std::string_view system, const ParameterMap& parameters);

}  // namespace qsmpc
