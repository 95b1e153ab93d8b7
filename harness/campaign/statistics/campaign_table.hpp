// A campaign's statistics as terminal output.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// Lines of at most 110 characters; names longer than their column are truncated and marked.
[[nodiscard]] std::string campaign_table(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
