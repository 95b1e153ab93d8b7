// Reading obstacles: boxes of states, and shapes of the plane of position.
#pragma once

#include <string>
#include <vector>

#include "controller/regions/safe_set.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Per safe set: every particle is tested against each obstacle.
inline constexpr std::size_t kMostObstacles = 1000;

/// The context of reading obstacles.
struct ObstacleReading {
  const models::SystemDescription& system;
  Problems& problems;
  std::size_t most = kMostObstacles;  ///< that may still be added
};

/// Whether the system has a plane of position, which shapes need.
[[nodiscard]] bool has_plane(const models::SystemDescription& system);

/// The obstacles in the list under `key` of `section`, each a mapping of states to [lower, upper],
/// or one shape. Invalid ones are noted and left out.
[[nodiscard]] std::vector<controller::Obstacle> read_obstacles(Section& section,
                                                               const std::string& key,
                                                               const ObstacleReading& reading);

/// An entry of that list on one line, which reads back bit for bit.
[[nodiscard]] std::string obstacle_text(const controller::Obstacle& obstacle,
                                        const models::SystemDescription& system);

}  // namespace qsmpc::harness
