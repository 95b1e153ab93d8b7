// Obstacles from what stands still in the plant's MuJoCo XML file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/safe_set.hpp"
#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/obstacle_reader.hpp"

namespace qsmpc::harness {

/// The keys of the section that says which geoms: `geoms`, their names, or `group`; and `height`.
[[nodiscard]] std::vector<KeyDescription> mjcf_obstacle_keys();

/// The projections on the ground of the geoms that `section` chooses among those of the file
/// `mjcf`. Noted are names that it does not have, what moves or has no shape on the ground, what is
/// not between the ground and the height, and a file that is no model.
[[nodiscard]] std::vector<controller::Obstacle> read_mjcf_obstacles(Section& section,
                                                                    const std::string& mjcf,
                                                                    const ObstacleReading& reading);

}  // namespace qsmpc::harness
