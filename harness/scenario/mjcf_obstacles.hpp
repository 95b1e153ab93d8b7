// Obstacles from the static geoms of the plant's MuJoCo XML file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/safe_set.hpp"
#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/obstacle_reader.hpp"

namespace qsmpc::harness {

/// The keys of the section that selects the geoms: `geoms`, their names, or `group`; and `height`.
[[nodiscard]] std::vector<KeyDescription> mjcf_obstacle_keys();

/// The projections on the ground of the geoms that `section` selects from the file `mjcf`. Notes
/// unknown names, geoms that move, have no shape on the ground or are not between the ground and
/// the height, and a file that is not a model.
[[nodiscard]] std::vector<controller::Obstacle> read_mjcf_obstacles(Section& section,
                                                                    const std::string& mjcf,
                                                                    const ObstacleReading& reading);

}  // namespace qsmpc::harness
