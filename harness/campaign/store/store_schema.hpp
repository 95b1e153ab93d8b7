// The tables of a campaign's store, and how older ones are brought up to date.
//
// For users, the tables are described in docs/campaign.md.
#pragma once

#include <functional>
#include <string>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Database;
}

namespace qsmpc::harness {

/// The file of the store within a campaign's folder.
inline constexpr const char* kStoreFile = "campaign.sqlite";

/// What brings a store from one schema to the next.
struct Migration {
  std::string sql{};
  /// Run after `sql`, where rows need more than SQL to become what they are in the next schema.
  void (*move_rows)(SQLite::Database& database) = nullptr;
  std::string after{};  ///< SQL that is run last
};

/// The first makes a store out of nothing.
[[nodiscard]] const std::vector<Migration>& store_migrations();

/// From this schema on an episode's periods are one row.
inline constexpr int kPeriodsSchemaNumber = 7;

/// The schema that this program writes and reads: the number of migrations.
[[nodiscard]] int store_schema();

/// What a store says it is: 0 for a file without tables. Throws InputError on an SQLite file that
/// is something else. `path` is what the error calls it.
[[nodiscard]] int schema_of(SQLite::Database& database, const std::string& path);

/// Applies the migrations after the first `from`, each in a transaction with its number, so that a
/// store is always of some schema as a whole.
void migrate(SQLite::Database& database, int from, const std::vector<Migration>& migrations);

/// Refuses a store of a newer schema. Throws InputError.
void refuse_newer(int schema, const std::string& path);

/// Runs `work` and turns what SQLite throws into an IoError that names the store at `path`.
void with_store_errors(const std::string& path, const std::function<void()>& work);

}  // namespace qsmpc::harness
