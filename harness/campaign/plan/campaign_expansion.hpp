// Expands a campaign file into all of its variants, each loaded and checked before anything is
// driven.
#pragma once

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

inline constexpr std::int64_t kMostCampaignVariants = 10'000;

/// Combines scenarios, variants, grid points (the grid's first key varies slowest) and plants;
/// scenarios vary slowest, plants fastest. Problems are added to `problems`; the campaign is valid
/// only if there are none. A problem with a setting or plant is reported at its line of the
/// campaign file, a problem of a scenario file in that file. More than kMostCampaignVariants are
/// refused without being expanded.
[[nodiscard]] Campaign expand_campaign(const CampaignDraft& draft, Problems& problems);

}  // namespace qsmpc::harness
