// A campaign's statistics for a terminal.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// Lines of at most 110 characters; names that are longer than their column are cut and marked.
[[nodiscard]] std::string campaign_table(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
