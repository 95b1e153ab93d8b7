// What the variants of a campaign are called.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/campaign/plan/campaign_refusals.hpp"

namespace qsmpc::harness {

/// Names `variants`, in the order in which they were made from `draft`: by scenario, settings and
/// plant, those of which the campaign has more than one; else by settings or scenario. A scenario
/// is called by its own name, or by the stem of its file (`scenario_paths`) where two have the same
/// name. Refuses names that are not unique.
void name_variants(const CampaignDraft& draft, const std::vector<std::string>& scenario_paths,
                   std::vector<CampaignVariant>& variants, CampaignRefusals& refusals);

}  // namespace qsmpc::harness
