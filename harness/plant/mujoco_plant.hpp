// A MuJoCo vehicle as plant, with the low-level loops that make it follow its system's inputs.
//
//   auto plant = qsmpc::make_mujoco_plant({.mjcf = "models/mjcf/dubins_car.xml",
//                                          .control_period = 0.1,
//                                          .mapping = qsmpc::dubins_car_mapping(1.5)});
//   plant->reset(state);
//   const qsmpc::PlantStep step = plant->advance(input, disturbance);
#pragma once

#include <memory>
#include <string>

#include "harness/plant/mujoco_mapping.hpp"
#include "harness/plant/plant.hpp"

namespace qsmpc {

struct MujocoPlantSetup {
  std::string mjcf;             ///< path of the XML
  double control_period = 0.1;  ///< s, a multiple of the model's timestep
  MujocoMapping mapping;
};

/// Loads the model and settles the vehicle on its suspension, rolling straight at its speed.
///
/// The plant's behaviour beyond Plant's contract:
/// - `reset` places the settled, rolling vehicle: no transient follows. The heading is kept as
/// given
///   and counted on from there, never wrapped.
/// - `advance` samples the motion about every 20 ms; the last two samples have the same time, the
///   period's end, before and after the disturbance. Times never decrease.
/// - The disturbance is a kick: x, y and heading jump, velocities turn with the vehicle, and
/// height,
///   roll, pitch and wheels stay.
/// - Any error or warning of MuJoCo, a state that is not finite (or huge, beyond 1e10), and an
/// input
///   or a disturbance that is not finite is a fault, "WORDS at TIME s": the state and the samples
///   are the last good ones, and every later step brings the same fault until `reset`.
/// - Vectors of a wrong size, and a state for `reset` that is not finite, throw
///   std::invalid_argument.
/// Steps with equal arguments after `reset` are equal bit for bit.
///
/// Throws InputError on a file that does not load, a name that the mapping needs and the model does
/// not have, a period that is no multiple of the timestep, and a vehicle that does not settle at
/// its speed.
[[nodiscard]] std::unique_ptr<Plant> make_mujoco_plant(const MujocoPlantSetup& setup);

}  // namespace qsmpc
