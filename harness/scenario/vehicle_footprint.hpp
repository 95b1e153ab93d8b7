// The discs that cover a MuJoCo vehicle, computed from its geometry: the footprint `from_mjcf`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/body.hpp"
#include "harness/mujoco/vehicle_outline.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"

namespace qsmpc::harness {

/// Discs of equal radius in a row along the longer axis of `outline` that cover it. Their number is
/// the smallest, up to five, for which they extend beyond its long sides by at most 15 % of its
/// width.
[[nodiscard]] std::vector<controller::Disc> covering_discs(const VehicleOutline& outline);

/// The discs that cover the vehicle of the MuJoCo file `mjcf`, with `mapping` or else the file's
/// own. For a system without heading, one disc about the position that contains the vehicle in the
/// file's orientation. Throws InputError where the file is not a model, and where its mapping does
/// not give the vehicle's position and heading in the world's own unit and direction.
[[nodiscard]] std::vector<controller::Disc> vehicle_footprint(
    const std::string& mjcf, const std::optional<PlantMapping>& mapping,
    const MappedSystem& system);

}  // namespace qsmpc::harness
