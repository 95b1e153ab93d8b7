// Conversion between rows of a campaign's store and C++ values.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/store/episode_row.hpp"
#include "harness/campaign/store/store_reader.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Column;
class Database;
class Statement;
}  // namespace SQLite

namespace qsmpc::harness {

/// Timeout for waiting for another user of the store, ms.
inline constexpr int kStorePatience = 20'000;

/// A connection that only reads the store in the file `path`; for one thread. Throws
/// SQLite::Exception.
[[nodiscard]] SQLite::Database open_store_to_read(const std::string& path);

/// The columns of an episode without its periods, as `episode_of` expects them; `e` and `t` are the
/// aliases of the tables `episode` and `episode_timing`.
[[nodiscard]] std::string episode_columns(const std::string& e, const std::string& t);
/// Their number.
inline constexpr int kEpisodeColumns = 23;

/// The episode in the current row of `statement`, from column `first` on.
[[nodiscard]] EpisodeRow episode_of(SQLite::Statement& statement, int first = 0);

/// A stored number; NaN is stored as NULL.
[[nodiscard]] double number_of(const SQLite::Column& column);

/// A seed as an SQLite integer, which is signed: seeds are below 2⁶³.
[[nodiscard]] std::int64_t stored_seed(std::uint64_t seed);

/// The tables whose rows belong to an episode; `variant` is a column of each.
inline constexpr std::array kEpisodeTables{"episode",         "episode_timing", "path",
                                           "episode_periods", "episode_ocp_ms", "rare_run",
                                           "episode_checksum"};

/// Whether a table of episodes contains wall-clock values, or checksums computed from them.
[[nodiscard]] bool is_timing(std::string_view table);

/// Parses an entry of the table of paths: JSON, a list of pairs. Throws SQLite::Exception on any
/// other text.
[[nodiscard]] std::vector<PathPoint> path_of(const std::string& text);

/// The SQL expression of an episode's outcome; `prefix` ("" or "e.") precedes its columns. Rows of
/// earlier versions have a single outcome for both parts of the unsafe set, and none for a drive
/// that continued after it was unsafe. All of these become that single outcome, since the rows do
/// not distinguish the parts.
[[nodiscard]] std::string outcome_column(const std::string& prefix = {});

/// The number of episodes by outcome.
[[nodiscard]] std::map<std::string, std::int64_t> count_outcomes(SQLite::Database& database);

/// Adds episodes with their periods, path and checksum. Must be used within transactions.
class EpisodeWriter {
 public:
  explicit EpisodeWriter(SQLite::Database& database);
  ~EpisodeWriter();
  EpisodeWriter(const EpisodeWriter&) = delete;
  EpisodeWriter& operator=(const EpisodeWriter&) = delete;

  /// Throws SQLite::Exception, also if the store already has the episode.
  void add(const EpisodeRow& row);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
/// Removes an episode with its periods, if it exists. Must be called within a transaction.
void delete_episode(SQLite::Database& database, std::int64_t variant, std::uint64_t seed);

[[nodiscard]] StoredCampaign read_campaign(SQLite::Database& database);
void insert_campaign(SQLite::Database& database, const StoredCampaign& campaign);

/// The variants, ordered by position.
[[nodiscard]] std::vector<StoredVariant> read_variants(SQLite::Database& database);
void insert_variant(SQLite::Database& database, const StoredVariant& variant,
                    std::int64_t position);

}  // namespace qsmpc::harness
