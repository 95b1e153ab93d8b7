// Variation of a vehicle relative to its file.
#pragma once

#include <mujoco/mujoco.h>

#include "harness/mujoco/named_model.hpp"
#include "harness/plant/plant_variation.hpp"
#include "harness/scenario/plant_mapping.hpp"

namespace qsmpc::harness {

/// Changes the friction of all geoms, the mass and inertia of all bodies, and the distance between
/// the axles that `mapping` names (steered wheels ahead of the fixed axle; sites of axle forces
/// about their body's origin). Forces that the plant applies itself are not in the model: see their
/// scale_friction. Throws InputError where a factor other than 1 has nothing to act on.
void vary_vehicle(const NamedModel& named, mjModel& model, const PlantMapping& mapping,
                  const PlantVariation& variation);

}  // namespace qsmpc::harness
