// A campaign's statistics as figures.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

inline constexpr const char* kOutcomesFile = "outcomes.svg";
inline constexpr const char* kReliabilityFile = "reliability.svg";
inline constexpr const char* kDifferencesFile = "differences.svg";
inline constexpr const char* kDistributionsFile = "distributions.svg";
inline constexpr const char* kTradeoffFile = "tradeoff.svg";
inline constexpr const char* kRareFile = "rare.svg";

/// A figure: charts that stand together, and the name of its file.
struct CampaignFigure {
  std::string file;  ///< e.g. "reliability.svg"
  std::vector<Chart> charts;
};

/// outcomes.svg (rates by variant), reliability.svg (what was observed against what was certified,
/// of all variants together and of each of up to 16 variants) and, where variants are compared,
/// differences.svg (by pair of variants, one chart a quantity); where drives differ,
/// distributions.svg (of cost, clearance and time); and where the campaign asks for it,
/// tradeoff.svg (risk against cost, one chart a scenario and plant) and rare.svg (estimates of how
/// probable an unsafe drive is, one chart a variant).
[[nodiscard]] std::vector<CampaignFigure> campaign_figures(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
