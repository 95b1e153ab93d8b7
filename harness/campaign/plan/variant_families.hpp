// The key `figure` of a campaign file: which variants are joined by a line.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/campaign/plan/campaign_refusals.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

/// The families of `figure`, the section of `node`, in the file's order; none if the key is missing
/// (`node` is nullptr). Invalid parts are added to `problems` and left out of the result.
[[nodiscard]] std::vector<FamilyDraft> read_families(Section figure, const YamlNode* node,
                                                     Problems& problems);

/// The families of `drafts`. Refuses members that are not among `known`, the campaign's settings.
[[nodiscard]] std::vector<VariantFamily> known_families(const std::vector<FamilyDraft>& drafts,
                                                        const std::vector<std::string>& known,
                                                        CampaignRefusals& refusals);

}  // namespace qsmpc::harness
