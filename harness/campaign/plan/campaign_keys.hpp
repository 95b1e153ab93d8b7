// The keys of a campaign file and their admissible values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/keys/key_tables.hpp"

namespace qsmpc::harness {

inline constexpr std::size_t kLongestCampaignDescription = 500;  ///< bytes; one line
inline constexpr int kMostCampaignSeeds = 1'000'000'000;
inline constexpr std::size_t kMostListedSeeds = 100'000;
inline constexpr std::size_t kMostFamilies = 6;  ///< of a figure: the number of available colours
inline constexpr int kMostRareParticles = 100'000;
inline constexpr NumberRange kRareFloor{.least = 0.0, .most = 0.1};
/// One past the last seed: integers in the store are signed.
inline constexpr std::uint64_t kSeedEnd = std::uint64_t{1} << 63U;

inline constexpr NumberRange kHalfwidthRange{.least = 0.0, .most = 0.25, .above_least = true};
inline constexpr NumberRange kStopConfidenceRange{.least = 0.5, .most = 0.999999};

/// The values of `traces`, in the order of TraceKeeping.
[[nodiscard]] const std::vector<std::string>& trace_keeping_names();

[[nodiscard]] const std::vector<KeyDescription>& campaign_keys();

/// The JSON Schema of a campaign file.
[[nodiscard]] nlohmann::ordered_json campaign_schema();

/// The documentation's table of its keys.
[[nodiscard]] std::vector<DocumentTable> campaign_tables();

}  // namespace qsmpc::harness
