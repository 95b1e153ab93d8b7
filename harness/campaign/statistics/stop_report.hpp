// Describes a campaign's stop rule for tables, pages and JSON.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc::harness {

/// "Stopped by its rule after 1200 of at most 10000 seeds: unsafe to +-0.01 at 99 % in every
/// variant."; or that it has not stopped yet. Empty for a campaign without a rule.
[[nodiscard]] std::string stop_sentence(const CampaignStatistics& statistics);

/// The kind of the rates' intervals: "99 % intervals", or "99 % intervals that hold at any number
/// of seeds" for a campaign with a rule.
[[nodiscard]] std::string interval_words(const CampaignStatistics& statistics);

/// {of, rate_halfwidth, confidence, stopped_after, variants: {NAME: {rate, interval}}}, with
/// intervals at that confidence. Precondition: the campaign has a rule.
[[nodiscard]] nlohmann::ordered_json stop_json(const CampaignStatistics& statistics);

}  // namespace qsmpc::harness
