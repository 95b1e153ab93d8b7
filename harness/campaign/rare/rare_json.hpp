// A variant's rare-outcome statistics as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/campaign/rare/rare_statistics.hpp"

namespace qsmpc::harness {

/// The object under `rare` of a variant in campaign.json; docs/rare.md describes its keys.
[[nodiscard]] nlohmann::ordered_json rare_json(const RareStatistics& statistics);

}  // namespace qsmpc::harness
