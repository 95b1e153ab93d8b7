// Names of a campaign's variants.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/campaign/plan/campaign_refusals.hpp"

namespace qsmpc::harness {

/// Names `variants`, which are in the order of their expansion from `draft`. A name consists of
/// those of scenario, settings and plant of which the campaign has more than one; if there are
/// none, it is that of the settings or else the scenario. A scenario goes by its own name, or by
/// the stem of its file (`scenario_paths`) if two have the same name. Refuses names that are not
/// unique.
void name_variants(const CampaignDraft& draft, const std::vector<std::string>& scenario_paths,
                   std::vector<CampaignVariant>& variants, CampaignRefusals& refusals);

}  // namespace qsmpc::harness
