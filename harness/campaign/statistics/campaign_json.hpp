// A campaign's statistics as JSON.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// The text of campaign.json: stable keys, one object, ending in a new line. Numbers that are not
/// finite are null. Wall-clock values stand under the keys `ocp_ms` alone: everything else is the
/// same in two runs.
[[nodiscard]] std::string campaign_json(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
