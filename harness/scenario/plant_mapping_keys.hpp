// The keys that describe how a system appears in a MuJoCo model, with their value ranges.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/scenario/keys/key_description.hpp"

namespace qsmpc::harness {

inline constexpr std::size_t kLongestElement = 200;  ///< bytes of a name in a MuJoCo model
inline constexpr std::size_t kMostMappingItems = 100;
inline constexpr WholeRange kComponentRange{0, 1000};                       // of a sensor
inline constexpr NumberRange kInputDelayRange{.least = 0.0, .most = 10.0};  // s
inline constexpr NumberRange kSettlingRange{.least = 0.0, .most = 1000.0};  // s

/// The kinds of low-level loops.
[[nodiscard]] const std::vector<std::string>& loop_kind_names();

/// All mapping keys, of `plant` in a scenario or of the custom text in a MuJoCo file.
[[nodiscard]] const std::vector<KeyDescription>& plant_mapping_keys();

}  // namespace qsmpc::harness
