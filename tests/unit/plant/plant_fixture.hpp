// Shared by the tests of plants: the shipped car, altered copies of it, and its numbers.
#pragma once

#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "harness/plant/mujoco/mujoco_plant.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

inline constexpr double kSpeed = 1.5;          // m/s
inline constexpr double kControlPeriod = 0.1;  // s
inline constexpr const char* kCarFile = QSMPC_SOURCE_DIR "/models/mjcf/dubins_car.xml";

inline MujocoPlantSetup car_setup(const std::string& mjcf = kCarFile,
                                  double control_period = kControlPeriod) {
  return {
      .mjcf = mjcf,
      .control_period = control_period,
      .system = models::make_dynamics("dubins", {{"speed", kSpeed}}, control_period)->description(),
      .parameters = {{"speed", kSpeed}}};
}

inline std::unique_ptr<Plant> make_car(const std::string& mjcf = kCarFile,
                                       double control_period = kControlPeriod) {
  return make_mujoco_plant(car_setup(mjcf, control_period));
}

inline Eigen::VectorXd pose(double x, double y, double heading) {
  return Eigen::Vector3d(x, y, heading);
}

inline Eigen::VectorXd yaw_rate(double value) { return Eigen::VectorXd::Constant(1, value); }

inline Eigen::VectorXd no_disturbance() { return Eigen::VectorXd::Zero(3); }

/// `vector` (x, y, heading) turned by `angle` in the plane.
inline Eigen::Vector3d turned(const Eigen::Vector3d& vector, double angle) {
  return {std::cos(angle) * vector.x() - std::sin(angle) * vector.y(),
          std::sin(angle) * vector.x() + std::cos(angle) * vector.y(), vector.z()};
}

/// The shipped car's XML with every `from` replaced by `to`; throws if there is none.
inline std::string altered_car(const std::string& from, const std::string& to) {
  std::ostringstream stream;
  stream << std::ifstream(kCarFile).rdbuf();
  std::string text = stream.str();
  std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the car's XML lacks " + from);
  for (; at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace qsmpc::harness
