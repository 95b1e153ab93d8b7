// What a campaign says of rare outcomes, for a terminal.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// A section of campaign_table; empty where the campaign does not look for rare outcomes.
[[nodiscard]] std::string rare_table(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
