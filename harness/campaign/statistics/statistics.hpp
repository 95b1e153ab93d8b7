// What a campaign's episodes say: how often they reach and fail, what differs between variants, and
// whether the certificates hold. From the rows of the store alone.
//
//   const CampaignStatistics statistics = campaign_statistics(StoreReader("out/my_campaign"));
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/campaign/statistics/calibration.hpp"
#include "harness/campaign/statistics/paired_difference.hpp"
#include "harness/campaign/statistics/tradeoff.hpp"
#include "harness/campaign/statistics/variant_pairs.hpp"
#include "harness/campaign/statistics/variant_statistics.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// Means over the seeds that both have done of (variant − baseline).
struct VariantDifference {
  VariantPair pair{};
  std::vector<MeanDifference> quantities{};
};

struct CampaignStatistics {
  StoredCampaign campaign{};
  std::int64_t done = 0;
  std::map<std::string, std::int64_t> outcomes{};
  std::vector<VariantStatistics> variants{};  ///< in the store's order
  std::vector<VariantDifference> differences{};
  std::vector<CalibrationBin> calibration{};  ///< over all variants
  std::vector<CalibrationBin> published{};
  double p_value = 1.0;                   ///< of all variants' periods
  std::vector<TradeoffPanel> tradeoff{};  ///< where the campaign asks for risk against cost
};

/// Reads every row some times, in a fixed order. Memory grows with the number of variants, and of a
/// variant at a time with its numbers that are sorted, up to kMostSortedValues of each kind.
/// Throws what the store throws.
[[nodiscard]] CampaignStatistics campaign_statistics(const StoreReader& store);

}  // namespace qsmpc::harness
