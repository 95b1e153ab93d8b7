// The motion of an obstacle in a scenario: {disc: {centre: [3, 4], radius: 0.3}, motion: {velocity:
// [0.5, 0], speed_deviation: 0.2}}.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/motion/obstacle_motion.hpp"

namespace qsmpc::harness {

inline constexpr const char* kMotionKey = "motion";
inline constexpr std::size_t kMostWays = 10;         ///< per obstacle
inline constexpr std::size_t kMostWayPlaces = 1000;  ///< per way

/// The mapping under kMotionKey.
[[nodiscard]] KeyDescription motion_key();

/// The motion under kMotionKey of `obstacle`, whose shape is centred at `centre`; nothing, and
/// noted problems, where it is invalid.
[[nodiscard]] std::optional<models::ObstacleMotion> read_motion(Section& obstacle,
                                                                const Eigen::Vector2d& centre);

/// The motion as a mapping on one line that `read_motion` reads back bit for bit.
[[nodiscard]] std::string motion_text(const models::ObstacleMotion& motion);

}  // namespace qsmpc::harness
