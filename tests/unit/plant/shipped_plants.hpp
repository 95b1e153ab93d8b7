// The shipped MuJoCo plants as the tests use them.
#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>

#include "harness/plant/mujoco/mujoco_plant.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

inline models::ParameterMap default_parameters(const std::string& system) {
  for (const models::SystemEntry& entry : models::systems()) {
    if (entry.name == system) return entry.defaults;
  }
  throw std::invalid_argument("no system " + system);
}

/// The plant of `system` in the shipped file `mjcf` with the system's default constants.
inline MujocoPlantSetup shipped_setup(const std::string& system, const std::string& mjcf,
                                      double control_period = 0.1) {
  const models::ParameterMap parameters = default_parameters(system);
  return {.mjcf = QSMPC_SOURCE_DIR "/models/mjcf/" + mjcf,
          .control_period = control_period,
          .system = models::make_dynamics(system, parameters, control_period)->description(),
          .parameters = parameters};
}

}  // namespace qsmpc::harness
