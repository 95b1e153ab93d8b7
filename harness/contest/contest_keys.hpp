// The keys of a contest file and their admissible values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/keys/key_tables.hpp"

namespace qsmpc::harness {

inline constexpr std::size_t kMostControllers = 20;
inline constexpr std::size_t kMostNoiseLevels = 10;
inline constexpr double kLargestNoise = 100.0;
inline constexpr int kLargestBudget = 1000;
inline constexpr int kMostTimingSeeds = 1000;
inline constexpr int kTimingSeeds = 3;

[[nodiscard]] const std::vector<KeyDescription>& contest_keys();

/// The JSON Schema of a contest file.
[[nodiscard]] nlohmann::ordered_json contest_schema();

/// The documentation's table of its keys.
[[nodiscard]] std::vector<DocumentTable> contest_tables();

/// Why the controllers of a contest may not differ in the scenario's `key`; empty if they may.
[[nodiscard]] std::string why_shared(const std::string& key);

}  // namespace qsmpc::harness
