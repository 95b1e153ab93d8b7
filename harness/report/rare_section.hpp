// A campaign's results on rare outcomes, as figures and as a section of its page.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// One chart for each variant that was searched for rare outcomes: the estimate of each run, their
/// mean, its limits and the certified value.
[[nodiscard]] std::vector<Chart> rare_charts(const CampaignStatistics& statistics);

/// Verdict, table, charts and commands that replay unsafe drives; empty if the campaign does not
/// look for rare outcomes.
[[nodiscard]] std::string rare_section(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
