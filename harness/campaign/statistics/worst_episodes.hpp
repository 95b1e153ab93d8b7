// The worst episodes of a campaign, which are the first to inspect.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/campaign/store/episode_row.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// Whether `one` is worse than `other`. Episodes whose true state was unsafe or that ended with a
/// fault are worst; then the order is by smallest clearance, then by highest cost, with NaN as
/// worst. Ties are broken by the earlier variant, then the smaller seed, so no two episodes of a
/// campaign are equal.
[[nodiscard]] bool is_worse(const EpisodeRow& one, const EpisodeRow& other);

/// The `count` worst episodes of all variants, or all if there are fewer, the worst first, without
/// their periods. Memory grows only with `count`. Throws what the store throws.
[[nodiscard]] std::vector<EpisodeRow> worst_episodes(const StoreReader& store, std::size_t count);

}  // namespace qsmpc::harness
