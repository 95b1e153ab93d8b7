// Risk against cost, for a campaign's page and tradeoff.svg.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// A chart for each scenario and plant: the rate of unsafe drives against the mean cost of those
/// that reached the target, both with 99 % intervals, with one line per family. Empty if the
/// campaign does not ask for it.
[[nodiscard]] std::vector<Chart> tradeoff_charts(const CampaignStatistics& statistics);

/// HTML: the charts, and a table of their numbers with how many drives reached the target and how
/// many timed out. Empty if there are no charts.
[[nodiscard]] std::string tradeoff_section(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
