// The discs that cover a MuJoCo vehicle, from its geometry: the footprint `from_mjcf`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/body.hpp"
#include "harness/mujoco/vehicle_outline.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"

namespace qsmpc::harness {

/// Discs of one radius in a row along the longer axis of `outline`, which they cover. Their number
/// is the least, and at most five, with which they reach beyond its long sides by no more than
/// 15 % of its width.
[[nodiscard]] std::vector<controller::Disc> covering_discs(const VehicleOutline& outline);

/// The discs that cover the vehicle of the MuJoCo file `mjcf`, which `mapping` describes (else what
/// the file says of itself). For a system without heading one disc about the position, which holds
/// the vehicle at the orientation that the file has it in. Throws InputError where the file is not
/// a model, and where its mapping does not say where the vehicle stands and heads in the world's
/// own unit and direction.
[[nodiscard]] std::vector<controller::Disc> vehicle_footprint(
    const std::string& mjcf, const std::optional<PlantMapping>& mapping,
    const MappedSystem& system);

}  // namespace qsmpc::harness
