// A private store into which the rows of other stores are merged.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/Database.h>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/store/merge.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// Episodes whose keys follow one another: those of some variants with some seeds.
struct KeyRange {
  std::int64_t first_variant = 0;  ///< as numbered in the joined store
  std::int64_t last_variant = 0;
  std::int64_t first_seed = 0;  ///< as stored, i.e. signed
  std::int64_t last_seed = 0;
};

/// Divides the keys of a campaign with `variants` variants into consecutive ranges of about
/// `episodes` episodes each; together they contain every key.
[[nodiscard]] std::vector<KeyRange> key_ranges(std::int64_t variants, const SeedSet& seeds,
                                               std::int64_t episodes);

/// Variants may be numbered differently in each of the stores. Throws SQLite::Exception if a store
/// cannot be read or written.
class JoinedStore {
 public:
  /// Creates the store of `campaign` in the empty file at `path`.
  JoinedStore(const std::string& path, const StoredCampaign& campaign,
              const std::vector<StoredVariant>& variants);

  [[nodiscard]] SQLite::Database& database() { return database_; }

  /// Adds the rows in `range` of the store in `folder`, of the same campaign. Throws InputError if
  /// it holds an episode that was already added, unless `policy` allows duplicates and the two
  /// agree. Fast where the pages of one range fit in the cache: add all stores' rows of one range
  /// before those of the next.
  void add(const std::string& folder, const MergePolicy& policy, const KeyRange& range);

 private:
  /// The numbers of each variant in the added store and in this one.
  using Numbers = std::vector<std::pair<std::int64_t, std::int64_t>>;
  struct Found {
    std::string variant;
    std::int64_t seed = 0;
  };

  /// What is being added.
  struct Part {
    Numbers variants;
    KeyRange range;
  };

  Numbers numbers(const KeyRange& range);
  std::optional<Found> first_row(const std::string& sql, const Part& part);
  void refuse_duplicates(const Part& part, const std::string& folder);
  void refuse_contradictions(const Part& part, const std::string& folder);
  void copy(const Part& part, bool ignore_duplicates);

  SQLite::Database database_;
};

}  // namespace qsmpc::harness
