// A campaign's statistics as JSON.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// The text of campaign.json: one object with stable keys, ending in a newline. Non-finite numbers
/// are null. Only the `ocp_ms` keys hold wall-clock values: everything else is reproducible.
[[nodiscard]] std::string campaign_json(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
