#include "harness/plant/mujoco_mapping.hpp"

#include <cmath>

#include "harness/errors.hpp"
#include "models/dynamics/dubins.hpp"

namespace qsmpc {

MujocoMapping dubins_car_mapping(double speed) {
  const AckermannSteering steering{
      .yaw_rate = Dubins::kYawRate,
      .speed = speed,
      .wheels = {{.joint = "front_left_steering", .actuator = "steer_left"},
                 {.joint = "front_right_steering", .actuator = "steer_right"}},
      .fixed_axle = {"rear_left_spin", "rear_right_spin"}};
  const SpeedHold drive{
      .speed = speed,
      .actuator = "drive",
      .wheels = {"rear_left_spin", "rear_right_spin", "front_left_spin", "front_right_spin"}};
  return {.pose = {.joint = "root", .x = Dubins::kX, .y = Dubins::kY, .heading = Dubins::kHeading},
          .loops = {steering, drive},
          .input_dim = Dubins::kInputDim};
}

MujocoMapping mujoco_mapping(std::string_view system, const ParameterMap& parameters) {
  if (system != "dubins") {
    throw InputError({.key = "model.system",
                      .found = std::string(system),
                      .expected = "dubins, the one system with a MuJoCo vehicle"});
  }
  const auto speed = parameters.find("speed");
  // The negation also refuses NaN.
  if (speed == parameters.end() || !(speed->second > 0.0) || !std::isfinite(speed->second)) {
    throw InputError({.key = "model.parameters.speed",
                      .found = speed == parameters.end() ? "none" : std::to_string(speed->second),
                      .expected = "a speed above 0 m/s: a car at rest cannot turn"});
  }
  return dubins_car_mapping(speed->second);
}

}  // namespace qsmpc
