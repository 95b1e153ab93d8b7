// A campaign's rare-outcome results for a terminal.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// A section of campaign_table; empty if the campaign does not search for rare outcomes.
[[nodiscard]] std::string rare_table(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
