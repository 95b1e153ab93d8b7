// The episodes of a campaign that one looks at first.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/campaign/store/episode_row.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// Whether `one` is worse than `other`: first those whose true state was unsafe or whose simulator
/// gave up, then by least clearance, then by highest cost; numbers that are none count as worst. Of
/// equal ones the earlier variant, then the earlier seed: no two episodes of a campaign are equal.
[[nodiscard]] bool is_worse(const EpisodeRow& one, const EpisodeRow& other);

/// The `count` worst episodes of all variants, the worst first, without their periods; fewer where
/// there are fewer. Memory grows with `count` only. Throws what the store throws.
[[nodiscard]] std::vector<EpisodeRow> worst_episodes(const StoreReader& store, std::size_t count);

}  // namespace qsmpc::harness
