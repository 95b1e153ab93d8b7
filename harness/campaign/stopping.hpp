// The rule that stops a campaign early, and the episodes that its store has.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/statistics/stop_rule.hpp"
#include "harness/campaign/store/store.hpp"

namespace qsmpc::harness {

/// The rule of `campaign`, told of what `store` has, without the episodes that ended with
/// `forgotten`. Throws std::invalid_argument of a campaign without a rule.
[[nodiscard]] StopRule stop_rule_of(const Campaign& campaign, const Store& store,
                                    const std::string& forgotten = {});

/// Where `campaign` has a rule and `store`, that of `folder`, has what it asks for: removes what is
/// beyond it, with its traces, and notes that the campaign has stopped. Returns how many first
/// seeds it has then; nothing where it has not stopped. Throws IoError.
std::optional<std::int64_t> stop_where_known(const Campaign& campaign, Store& store,
                                             const std::string& folder);

/// Removes the folders of traces, which are relative to the campaign's `folder`. Throws IoError.
void remove_traces(const std::string& folder, const std::vector<std::string>& traces);

/// Throws InputError where `campaign` has a rule and only a part of its seeds would be driven.
void refuse_shard_of_rule(const Campaign& campaign, const Shard& shard);

}  // namespace qsmpc::harness
