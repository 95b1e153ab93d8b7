// Drives the missing episodes of a campaign's folder, with progress on the terminal and support for
// Ctrl-C.
#pragma once

#include <string>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/runner.hpp"

namespace qsmpc::harness {

/// Throws InputError, which names `file`, if `jobs` simultaneous drives of some variant need more
/// memory than there is.
void refuse_beyond_memory(const Campaign& campaign, const std::string& file, int jobs);

/// The progress output. In its `options`, drive_campaign itself sets when to stop and the
/// callbacks.
struct CampaignTalk {
  std::string label = "driving";
  bool quiet = false;
};

/// As run_campaign. The first Ctrl-C lets running episodes finish, a second one abandons them.
[[nodiscard]] CampaignProgress drive_campaign(const Campaign& campaign, const std::string& folder,
                                              CampaignOptions options, const CampaignTalk& talk);

}  // namespace qsmpc::harness
