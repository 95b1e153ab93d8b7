// The shards of a campaign, driven on several machines, joined into one store.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace qsmpc::harness {

struct MergeResult {
  std::int64_t episodes = 0;
  std::int64_t traces = 0;  ///< files that were copied
};

/// Joins the stores of all shards of a campaign, in `folders`, and the traces that they keep, in
/// the folder `out`, which is made if need be and holds no campaign yet. The shards stay as they
/// are. The store appears under its name when all is in it and on the disk.
///
/// Throws InputError, and leaves no store, unless the folders hold each shard of one campaign once,
/// of the same scenarios, vehicles and version, and together each of its episodes exactly once; it
/// names what is missing, double or foreign. Throws IoError where something cannot be read or
/// written, or another process works in `out`.
MergeResult merge_shards(const std::vector<std::string>& folders, const std::string& out);

}  // namespace qsmpc::harness
