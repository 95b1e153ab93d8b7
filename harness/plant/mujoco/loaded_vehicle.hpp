// A vehicle's MuJoCo file as its plant uses it. Private to the MuJoCo plant.
#pragma once

#include "harness/mujoco/mujoco_model.hpp"
#include "harness/plant/mujoco/mujoco_plant.hpp"

namespace qsmpc::harness {

/// A model with its time step and variation, and the mapping that goes with it.
struct LoadedVehicle {
  MujocoModelPtr model;
  PlantMapping mapping;
};

/// Loads the model of `setup`; the mapping is that of `setup`, or else the model's own.
/// Throws InputError where the file is not a model, has no mapping or a wrong one, or where the
/// time step is not one that the mapping allows.
[[nodiscard]] LoadedVehicle load_vehicle(const MujocoPlantSetup& setup);

}  // namespace qsmpc::harness
