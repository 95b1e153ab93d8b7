// Applies a campaign's stop rule to the episodes in its store.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/statistics/stop_rule.hpp"
#include "harness/campaign/store/store.hpp"

namespace qsmpc::harness {

/// The rule of `campaign`, fed with the episodes in `store` except those with the outcome
/// `forgotten`. Throws std::invalid_argument if the campaign has no rule.
[[nodiscard]] StopRule stop_rule_of(const Campaign& campaign, const Store& store,
                                    const std::string& forgotten = {});

/// If `campaign` has a rule and `store`, the one in `folder`, satisfies it: removes the episodes of
/// later seeds with their traces, and records that the campaign has stopped. Returns the number of
/// first seeds kept, or nothing if it has not stopped. Throws IoError.
std::optional<std::int64_t> stop_where_known(const Campaign& campaign, Store& store,
                                             const std::string& folder);

/// Removes the folders `traces`, which are relative to the campaign's `folder`. Throws IoError.
void remove_traces(const std::string& folder, const std::vector<std::string>& traces);

/// Throws InputError if `campaign` has a rule and `shard` is only a part of its seeds.
void refuse_shard_of_rule(const Campaign& campaign, const Shard& shard);

}  // namespace qsmpc::harness
