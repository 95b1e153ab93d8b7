// A private store into which the rows of other stores are merged.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/Database.h>

#include "harness/campaign/store/merge.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// Variants may be numbered differently in each of the stores. Throws SQLite::Exception if a store
/// cannot be read or written.
class JoinedStore {
 public:
  /// Creates the store of `campaign` in the empty file at `path`.
  JoinedStore(const std::string& path, const StoredCampaign& campaign,
              const std::vector<StoredVariant>& variants);

  [[nodiscard]] SQLite::Database& database() { return database_; }

  /// Adds the rows of the store in `folder`, of the same campaign. Throws InputError if it holds an
  /// episode that was already added, unless `policy` allows duplicates and the two agree.
  void add(const std::string& folder, const MergePolicy& policy);

 private:
  /// The numbers of each variant in the added store and in this one.
  using Numbers = std::vector<std::pair<std::int64_t, std::int64_t>>;
  struct Found {
    std::string variant;
    std::int64_t seed = 0;
  };

  Numbers numbers();
  std::optional<Found> first_row(const std::string& sql, const Numbers& variants);
  void refuse_duplicates(const Numbers& variants, const std::string& folder);
  void refuse_contradictions(const Numbers& variants, const std::string& folder);
  void copy(const Numbers& variants, bool ignore_duplicates);

  SQLite::Database database_;
};

}  // namespace qsmpc::harness
