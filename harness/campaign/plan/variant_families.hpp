// The key `figure` of a campaign file: which variants are joined by a line.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/campaign/plan/campaign_refusals.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

/// The families of `figure`, the section of `node`, in the file's order; none where the key is not
/// there (`node` is nullptr). Everything wrong is noted in `problems`, and left out of what is
/// returned.
[[nodiscard]] std::vector<FamilyDraft> read_families(Section figure, const YamlNode* node,
                                                     Problems& problems);

/// The families of `drafts`. Refuses members that are not one of `known`, the settings that the
/// campaign has.
[[nodiscard]] std::vector<VariantFamily> known_families(const std::vector<FamilyDraft>& drafts,
                                                        const std::vector<std::string>& known,
                                                        CampaignRefusals& refusals);

}  // namespace qsmpc::harness
