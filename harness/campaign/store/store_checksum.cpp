#include "harness/campaign/store/store_checksum.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>

#include "harness/text/fnv1a.hpp"

namespace qsmpc::harness {
namespace {

// Columns by name. Those that later schemas add are in queries of their own, which count only where
// they have a row: checksums that were made before stay what they are.
constexpr std::array kQueries{
    "SELECT outcome, fault, steps, time_to_target, unsafe, min_clearance, cost, next_step_max, "
    "next_step_sum, horizon_max, thesis_max, iterations_median, fallbacks, trace, version, "
    "risk_exceeded FROM episode WHERE variant = ? AND seed = ?",
    "SELECT finished_at, wall_ms, deadline_misses FROM episode_timing "
    "WHERE variant = ? AND seed = ?",
    "SELECT period, certified, published, unsafe FROM period WHERE variant = ? AND seed = ? "
    "ORDER BY period",
    "SELECT period, ocp_ms FROM period_timing WHERE variant = ? AND seed = ? ORDER BY period",
    "SELECT points FROM path WHERE variant = ? AND seed = ?",
    "SELECT believed_max, believed_sum FROM episode WHERE variant = ? AND seed = ? AND "
    "(believed_max IS NOT NULL OR believed_sum IS NOT NULL)",
    "SELECT particles, floor, probability, collision, left_bounds, levels, drives, periods, "
    "extinct, "
    "below_floor, plain_unsafe, plain_periods, plain_faults, certified, found FROM rare_run WHERE "
    "variant = ? AND seed = ?"};
constexpr std::size_t kFirstQueries = 5;  // that checksums have had from the beginning

using Hash = Fnv1a<std::uint64_t>;

void add_text(std::string_view text, Hash& hash) {
  hash.add(static_cast<std::uint64_t>(text.size()));
  hash.add(text);
}

void add_column(const SQLite::Column& column, Hash& hash) {
  hash.add(static_cast<std::uint64_t>(column.getType()));
  if (column.isInteger()) hash.add(static_cast<std::uint64_t>(column.getInt64()));
  if (column.isFloat()) hash.add(std::bit_cast<std::uint64_t>(column.getDouble()));
  if (column.isText()) add_text(column.getString(), hash);
}

/// Checksums of episodes of one store.
class Checksums {
 public:
  explicit Checksums(SQLite::Database& database)
      : statements_{
            SQLite::Statement(database, kQueries[0]), SQLite::Statement(database, kQueries[1]),
            SQLite::Statement(database, kQueries[2]), SQLite::Statement(database, kQueries[3]),
            SQLite::Statement(database, kQueries[4]), SQLite::Statement(database, kQueries[5]),
            SQLite::Statement(database, kQueries[6])} {}

  std::int64_t of(std::int64_t variant, std::int64_t seed) {
    Hash hash;
    hash.add(static_cast<std::uint64_t>(seed));
    for (std::size_t n = 0; n < statements_.size(); ++n) {
      SQLite::Statement& statement = statements_[n];
      statement.bind(1, variant);
      statement.bind(2, seed);
      std::uint64_t rows = 0;
      for (; statement.executeStep(); ++rows) {
        for (int k = 0; k < statement.getColumnCount(); ++k) {
          add_column(statement.getColumn(k), hash);
        }
      }
      if (n < kFirstQueries || rows > 0) hash.add(rows);
      statement.reset();
    }
    return static_cast<std::int64_t>(hash.value());
  }

 private:
  std::array<SQLite::Statement, kQueries.size()> statements_;
};

}  // namespace

void insert_checksum(SQLite::Database& database, std::int64_t variant, std::int64_t seed) {
  SQLite::Statement statement(database, "INSERT INTO episode_checksum VALUES (?, ?, ?)");
  statement.bind(1, variant);
  statement.bind(2, seed);
  statement.bind(3, Checksums(database).of(variant, seed));
  statement.exec();
}

std::optional<StoredEpisode> damaged_episode(SQLite::Database& database) {
  Checksums checksums(database);
  SQLite::Statement statement(database, "SELECT variant, seed, checksum FROM episode_checksum");
  while (statement.executeStep()) {
    const StoredEpisode episode{.variant = statement.getColumn(0).getInt64(),
                                .seed = statement.getColumn(1).getInt64()};
    if (checksums.of(episode.variant, episode.seed) != statement.getColumn(2).getInt64()) {
      return episode;
    }
  }
  return std::nullopt;
}

}  // namespace qsmpc::harness
