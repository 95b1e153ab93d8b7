// Reads and writes rare-outcome rows of a campaign's store.
#pragma once

#include <cstdint>
#include <string>

#include "harness/campaign/rare/rare_row.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Database;
class Statement;
}  // namespace SQLite

namespace qsmpc::harness {

/// The columns of a row of the table `rare_run`, as `rare_row_of` expects them.
[[nodiscard]] std::string rare_columns();
/// The current row of `statement`, from column `first` on. Throws SQLite::Exception if its list of
/// drives is malformed.
[[nodiscard]] RareRow rare_row_of(SQLite::Statement& statement, int first);

/// Adds the row of an episode. Must be called within a transaction.
void insert_rare(SQLite::Database& database, std::int64_t variant, std::int64_t seed,
                 const RareRow& row);

/// rare_text of the stored campaign; empty if it does not search for rare outcomes.
[[nodiscard]] std::string read_rare_settings(SQLite::Database& database);
void insert_rare_settings(SQLite::Database& database, const std::string& settings);

}  // namespace qsmpc::harness
