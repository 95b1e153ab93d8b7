// The results in a campaign's store, as files beside it and on the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// The campaign file as it was given, in the campaign's folder.
inline constexpr const char* kCampaignCopy = "campaign.yaml";

/// Number of episodes that a campaign's page lists.
inline constexpr std::size_t kWorstListed = 10;

/// Reads the store in `folder` and writes beside it campaign.json, the CSV files, the figures and
/// the page with the `worst` worst episodes, each atomically. `is_verified`: the checksums of the
/// store have just been compared. Throws as StoreReader does, and IoError.
CampaignStatistics write_campaign_results(const std::string& folder,
                                          std::size_t worst = kWorstListed,
                                          bool is_verified = false);

/// Prints the table and the names of the files, or campaign.json.
void print_campaign_results(const CampaignStatistics& statistics, const std::string& folder,
                            bool json);

/// Whether anything that --fail-on names has occurred.
[[nodiscard]] bool asked_to_tell(const std::vector<std::string>& fail_on,
                                 const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
