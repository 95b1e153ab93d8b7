// What a campaign says of rare outcomes, as figures and as a section of its page.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// One chart a variant that was looked for rare outcomes in: the estimate of each run, with their
/// mean, its limits and what was certified.
[[nodiscard]] std::vector<Chart> rare_charts(const CampaignStatistics& statistics);

/// Verdict, table, charts and commands that drive unsafe drives again; empty where the campaign
/// does not look for rare outcomes.
[[nodiscard]] std::string rare_section(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
