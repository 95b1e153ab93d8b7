// Stores of one campaign that was driven in several places, joined into one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace qsmpc::harness {

struct MergeResult {
  std::int64_t episodes = 0;  ///< that the joined store has
  std::int64_t asked = 0;     ///< episodes of the campaign
  std::int64_t traces = 0;    ///< that were copied
};

/// What stores that are joined may be.
struct MergePolicy {
  /// Whether several of them may hold the same episode. It is taken once, from the first folder
  /// that has it; the others must agree with it in all but timings.
  bool duplicates = false;
  /// Whether episodes of the campaign may be missing from all of them.
  bool incomplete = false;
  /// Whether a store that is in `out` already is replaced.
  bool replace = false;
};

/// Joins the stores in `folders`, and the traces that they keep, in the folder `out`, which is made
/// if need be. They are of the same campaign and the same shard of it, and stay as they are; any
/// number of them can be joined, as one is open at a time. With `policy.replace`, `out` may be one
/// of them. Every episode is compared with its
/// checksum on the way. The store appears under its name when all is in it and on the disk.
///
/// Throws InputError, and leaves `out` without a new store, where the folders are of different
/// campaigns, shards, scenarios, vehicles or versions, or hold episodes that the campaign does not
/// ask for or that `policy` does not allow; it names what is missing, double or foreign. Throws
/// IoError where something is damaged or cannot be read or written, or another process works in
/// `out`.
MergeResult merge_stores(const std::vector<std::string>& folders, const std::string& out,
                         const MergePolicy& policy);

/// The same of the stores of all shards of a campaign, each of which is there once, and which hold
/// each episode of the campaign exactly once. `out` holds no campaign yet. What is joined is the
/// whole campaign.
MergeResult merge_shards(const std::vector<std::string>& folders, const std::string& out);

}  // namespace qsmpc::harness
