// The plan of a campaign: what it would drive.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "harness/campaign/campaign.hpp"

namespace qsmpc::harness {

/// {of, rate_halfwidth, confidence}.
[[nodiscard]] nlohmann::ordered_json until_json(const StopCriterion& until);

/// "campaign NAME: 4 variants x 200 seeds = 800 episodes".
[[nodiscard]] std::string campaign_size_text(const Campaign& campaign);

/// A table with a line for every variant (its number, name, overrides and plant), then the seeds,
/// the total number of episodes and which traces are kept.
[[nodiscard]] std::string campaign_plan_text(const Campaign& campaign);

/// The same as one object with stable keys, ending in a newline; docs/campaign.md describes them.
[[nodiscard]] std::string campaign_plan_json(const Campaign& campaign);

}  // namespace qsmpc::harness
