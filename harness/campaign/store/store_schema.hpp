// The tables of a campaign's store and the migration of older ones.
//
// docs/campaign.md describes the tables for users.
#pragma once

#include <functional>
#include <string>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Database;
}

namespace qsmpc::harness {

/// The name of the store's file in a campaign's folder.
inline constexpr const char* kStoreFile = "campaign.sqlite";

/// Migrates a store from one schema to the next.
struct Migration {
  std::string sql{};
  /// Run after `sql`, if converting rows to the next schema takes more than SQL.
  void (*move_rows)(SQLite::Database& database) = nullptr;
  std::string after{};  ///< SQL that runs last
};

/// All migrations; the first creates a new store.
[[nodiscard]] const std::vector<Migration>& store_migrations();

/// From this schema on, an episode's periods are stored in one row.
inline constexpr int kPeriodsSchemaNumber = 7;

/// The schema that this program writes and reads: the number of migrations.
[[nodiscard]] int store_schema();

/// The schema number recorded in a store; 0 for a file without tables. Throws InputError if the
/// SQLite file is not a store. `path` is its name in the error.
[[nodiscard]] int schema_of(SQLite::Database& database, const std::string& path);

/// Applies the migrations after the first `from`. Each runs in one transaction that also sets the
/// schema number, so a store is always entirely of one schema.
void migrate(SQLite::Database& database, int from, const std::vector<Migration>& migrations);

/// Refuses a store of a newer schema. Throws InputError.
void refuse_newer(int schema, const std::string& path);

/// Runs `work` and converts SQLite exceptions to an IoError that names the store at `path`.
void with_store_errors(const std::string& path, const std::function<void()>& work);

}  // namespace qsmpc::harness
