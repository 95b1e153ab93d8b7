// All combinations that a campaign file asks for, each loaded and checked before anything is
// driven.
#pragma once

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

inline constexpr std::int64_t kMostCampaignVariants = 10'000;

/// Scenarios, variants, points of the grid (its first key varies slowest) and plants combined, the
/// first of them slowest. Everything wrong is noted in `problems`; the campaign is valid only if
/// nothing was. Problems with a setting or plant are in the campaign's file, at the line of it;
/// problems of a scenario file are in that file. More than kMostCampaignVariants are refused
/// without being made.
[[nodiscard]] Campaign expand_campaign(const CampaignDraft& draft, Problems& problems);

}  // namespace qsmpc::harness
