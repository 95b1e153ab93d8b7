// The outcomes of a campaign's drives: the first part of its page.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/report/table_page.hpp"

namespace qsmpc::harness {

/// Bad if a drive was unsafe; good if all finished drives reached the target.
[[nodiscard]] PageVerdict outcome_verdict(const CampaignStatistics& statistics);

/// HTML: the verdict, and a table with a bar and the rates of each variant.
[[nodiscard]] std::string campaign_outcomes(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
