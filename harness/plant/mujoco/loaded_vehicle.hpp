// Loading of a vehicle's MuJoCo file for its plant. Private to the MuJoCo plant.
#pragma once

#include "harness/mujoco/mujoco_model.hpp"
#include "harness/plant/mujoco/mujoco_plant.hpp"

namespace qsmpc::harness {

/// A model with its time step and variation applied, and its mapping.
struct LoadedVehicle {
  MujocoModelPtr model;
  PlantMapping mapping;
};

/// Loads the model of `setup`, with the mapping of `setup` or else the model's own. Throws
/// InputError where the file is not a model, where it has no mapping or an invalid one, or where
/// the mapping does not allow the time step.
[[nodiscard]] LoadedVehicle load_vehicle(const MujocoPlantSetup& setup);

}  // namespace qsmpc::harness
