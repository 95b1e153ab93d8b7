// Driving what a campaign's folder lacks, with progress on the terminal and Ctrl-C.
#pragma once

#include <string>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/runner.hpp"

namespace qsmpc::harness {

/// Throws InputError, which names `file`, where `jobs` drives of some variant at the same time need
/// more memory than there is.
void refuse_beyond_memory(const Campaign& campaign, const std::string& file, int jobs);

/// What the progress says, and what of `options` is left to it: when to stop, and who is told.
struct CampaignTalk {
  std::string label = "driving";
  bool quiet = false;
};

/// As run_campaign. Ctrl-C lets the episodes that have begun end, a second one gives them up.
[[nodiscard]] CampaignProgress drive_campaign(const Campaign& campaign, const std::string& folder,
                                              CampaignOptions options, const CampaignTalk& talk);

}  // namespace qsmpc::harness
