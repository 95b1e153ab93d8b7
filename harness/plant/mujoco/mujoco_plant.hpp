// A MuJoCo vehicle as a plant, with the low-level loops that make it follow its system's inputs.
//
//   auto plant = qsmpc::harness::make_mujoco_plant({.mjcf = "models/mjcf/dubins_car.xml",
//                                          .control_period = 0.1,
//                                          .system = dynamics.description(),
//                                          .parameters = {{"speed", 1.5}}});
//   plant->reset(state);
//   const qsmpc::harness::PlantStep step = plant->advance(input, disturbance);
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "harness/plant/plant.hpp"
#include "harness/plant/plant_variation.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

struct MujocoPlantSetup {
  std::string mjcf;                       ///< path of the XML
  double control_period = 0.1;            ///< s, a multiple of the model's time step
  models::SystemDescription system;       ///< the system whose states and inputs are mapped
  models::ParameterMap parameters;        ///< constants of the system, all of them
  std::optional<PlantMapping> mapping{};  ///< else the mapping in the XML
  std::optional<double> time_step{};      ///< s; else the XML's
  PlantVariation variation{};
  /// Its walls and obstacles collide with the vehicle; without it, nothing is solid.
  std::optional<controller::SafeSet> solid{};
  /// If not empty, the disturbance acts as a force, and this is its covariance, state_dim x
  /// state_dim: the scale for how closely the force must reproduce the disturbance.
  Eigen::MatrixXd force_covariance{};
};

/// Loads the model and settles the vehicle on its suspension, rolling straight ahead if it holds a
/// speed.
///
/// The plant's behaviour beyond Plant's contract:
/// - `reset` places the settled vehicle, so that no transient follows. The heading is kept as given
///   and unwrapped from there. States that are read from sensors, and the roll and pitch of bodies,
///   are those of the settled vehicle.
/// - `advance` samples the motion about every 20 ms; the last two samples have the same time, the
///   end of the period, before and after the disturbance. Times never decrease.
/// - The disturbance is either a jump of the states (velocities turn with the vehicle; height,
///   roll, pitch and wheels are unchanged), or a force: springs and dampers along the position
///   states pull the vehicle, as closely as can be found, to where the jump would have brought it.
/// - Any error or warning of MuJoCo, a state that is not finite (or huge, beyond 1e10), and an
///   input or a disturbance that is not finite is a fault, "WORDS at TIME s": the state and the
///   samples are the last good ones, and every later step returns the same fault until `reset`.
/// - A state for `reset` that MuJoCo rejects, e.g. a huge one, throws SimulatorError.
/// - Vectors of the wrong size, and a state for `reset` that is not finite, throw
///   std::invalid_argument.
/// The same steps after `reset` give the same results, bit for bit.
///
/// Throws InputError on a file that does not load, a mapping that is missing or names elements that
/// the model does not have, a period that is not a multiple of the time step, a time step that the
/// mapping does not allow, a variation or a force that nothing can be applied to, and a vehicle
/// that does not settle at its speed.
[[nodiscard]] std::unique_ptr<Plant> make_mujoco_plant(const MujocoPlantSetup& setup);

}  // namespace qsmpc::harness
