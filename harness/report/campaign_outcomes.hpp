// What became of a campaign's drives: the part of its page that comes first.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/report/table_page.hpp"

namespace qsmpc::harness {

/// Bad where a drive was unsafe; good where all that are done reached the target.
[[nodiscard]] PageVerdict outcome_verdict(const CampaignStatistics& statistics);

/// HTML: the verdict, and a table with a bar and the rates of each variant.
[[nodiscard]] std::string campaign_outcomes(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
