// Merges the stores of a campaign that was driven in several places.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace qsmpc::harness {

struct MergeResult {
  std::int64_t episodes = 0;  ///< episodes in the merged store
  std::int64_t asked = 0;     ///< episodes of the campaign
  std::int64_t traces = 0;    ///< traces copied
};

/// What is allowed of the stores to merge.
struct MergePolicy {
  /// Whether several of them may contain the same episode. It is taken once, from the first folder
  /// that has it; the others must agree with it except in timings.
  bool duplicates = false;
  /// Whether episodes of the campaign may be missing from all of them.
  bool incomplete = false;
  /// Whether an existing store in `out` is replaced.
  bool replace = false;
  /// Episodes of the campaign that are copied from all stores before the next ones, >= 1. Does not
  /// change the result.
  std::int64_t episodes_at_a_time = 250'000;
};

/// Merges the stores in `folders` and their kept traces into the folder `out`, which is created if
/// necessary. They must be of the same campaign and the same shard, and are not modified; their
/// number is unlimited, as only one is open at a time. With `policy.replace`, `out` may be one of
/// them. Every episode is verified against its checksum. The store gets its final name only when it
/// is complete and on disk.
///
/// Throws InputError, and leaves `out` without a new store, if the folders are of different
/// campaigns, shards, scenarios, vehicles or versions, or if they contain episodes that are not in
/// the campaign, or duplicates or gaps that `policy` does not allow; the error names what is
/// missing, duplicated or foreign. Throws IoError if something is damaged or cannot be read or
/// written, or if another process works in `out`.
MergeResult merge_stores(const std::vector<std::string>& folders, const std::string& out,
                         const MergePolicy& policy);

/// The same for the stores of all shards of a campaign, each given once, which together must
/// contain each episode of the campaign exactly once. `out` must not contain a campaign yet. The
/// result is the whole campaign.
MergeResult merge_shards(const std::vector<std::string>& folders, const std::string& out);

}  // namespace qsmpc::harness
