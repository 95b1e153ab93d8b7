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

/// A figure: charts shown together, and the name of its file.
struct CampaignFigure {
  std::string file;  ///< e.g. "reliability.svg"
  std::vector<Chart> charts;
};

/// outcomes.svg (rates by variant) and reliability.svg (observed against certified rates, for all
/// variants together and for each of up to 16 variants). If variants are compared, also
/// differences.svg (by pair of variants, one chart per quantity); if drives differ,
/// distributions.svg (of cost, clearance and time); and if the campaign asks for them, tradeoff.svg
/// (risk against cost, one chart per scenario and plant) and rare.svg (estimates of the probability
/// of an unsafe drive, one chart per variant).
[[nodiscard]] std::vector<CampaignFigure> campaign_figures(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
