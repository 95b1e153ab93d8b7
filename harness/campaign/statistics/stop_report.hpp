// What tables, pages and JSON say of the rule that stops a campaign early.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// "Stopped by its rule after 1200 of at most 10000 seeds: unsafe to +-0.01 at 99 % in every
/// variant."; or that it has not stopped yet. Empty of a campaign without a rule.
[[nodiscard]] std::string stop_sentence(const CampaignStatistics& statistics);

/// What the intervals of rates are: "99 % intervals", or "99 % intervals that hold at any number of
/// seeds" of a campaign with a rule.
[[nodiscard]] std::string interval_words(const CampaignStatistics& statistics);

/// {of, rate_halfwidth, confidence, stopped_after, variants: {NAME: {rate, interval}}}, the
/// intervals at that confidence. The campaign has a rule.
[[nodiscard]] nlohmann::ordered_json stop_json(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
