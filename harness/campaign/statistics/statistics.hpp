// A campaign's statistics: how often episodes reach the target and fail, how variants differ, and
// whether the certificates hold. Computed only from the rows of the store.
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

/// Means of (variant − baseline) over the seeds that both have done.
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
  std::vector<TradeoffPanel> tradeoff{};  ///< if the campaign requests risk against cost
};

/// Reads every row several times, in a fixed order. Memory grows with the number of variants, plus,
/// for one variant at a time, the values that are sorted, up to kMostSortedValues of each kind.
/// Throws what the store throws.
[[nodiscard]] CampaignStatistics campaign_statistics(const StoreReader& store);

}  // namespace qsmpc::harness
