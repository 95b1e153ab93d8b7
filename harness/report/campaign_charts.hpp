// A campaign's statistics as figures.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// A figure: charts that stand together, and the name of its file.
struct CampaignFigure {
  std::string file;  ///< e.g. "reliability.svg"
  std::vector<Chart> charts;
};

/// outcomes.svg (rates by variant), reliability.svg (what was observed against what was certified,
/// of all variants together and of each of up to 16 variants) and, where variants are compared,
/// differences.svg (by pair of variants, one chart a quantity).
[[nodiscard]] std::vector<CampaignFigure> campaign_figures(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
