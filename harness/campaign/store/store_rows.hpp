// Rows of a campaign's store, to and from the values that stand for them.
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

/// How long one waits for the other who uses the store, ms.
inline constexpr int kStorePatience = 20'000;

/// The columns of an episode without its periods, as `episode_of` expects them, from the tables
/// `episode` and `episode_timing` under the names `e` and `t`.
[[nodiscard]] std::string episode_columns(const std::string& e, const std::string& t);
/// How many they are.
inline constexpr int kEpisodeColumns = 23;

/// The episode in the columns of the row that `statement` is at, from column `first` on.
[[nodiscard]] EpisodeRow episode_of(SQLite::Statement& statement, int first = 0);

/// A number as it was stored: what is not a number is stored as NULL.
[[nodiscard]] double number_of(const SQLite::Column& column);

/// Seeds are below 2⁶³, as SQLite's integers are.
[[nodiscard]] std::int64_t stored_seed(std::uint64_t seed);

/// The tables whose rows belong to an episode; `variant` is a column of each.
inline constexpr std::array kEpisodeTables{"episode",         "episode_timing", "path",
                                           "episode_periods", "episode_ocp_ms", "rare_run",
                                           "episode_checksum"};

/// Whether a table of episodes holds wall-clock values, or a checksum that is made of some.
[[nodiscard]] bool is_timing(std::string_view table);

/// What the table of paths holds: JSON, a list of pairs. Throws SQLite::Exception of another text.
[[nodiscard]] std::vector<PathPoint> path_of(const std::string& text);

/// The outcome of the episode whose columns begin with `prefix` ("" or "e."), in SQL. Rows of
/// earlier versions have one word for both parts of the unsafe set, and none for a drive that went
/// on after it was unsafe: all of these become that one word, for no row tells the parts apart.
[[nodiscard]] std::string outcome_column(const std::string& prefix = {});

/// Episodes by how they ended.
[[nodiscard]] std::map<std::string, std::int64_t> count_outcomes(SQLite::Database& database);

/// Adds episodes with their periods, path and checksum. To be used within transactions.
class EpisodeWriter {
 public:
  explicit EpisodeWriter(SQLite::Database& database);
  ~EpisodeWriter();
  EpisodeWriter(const EpisodeWriter&) = delete;
  EpisodeWriter& operator=(const EpisodeWriter&) = delete;

  /// Throws SQLite::Exception, also where the store has the episode.
  void add(const EpisodeRow& row);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
/// Removes an episode with its periods, if it is there. To be called within a transaction.
void delete_episode(SQLite::Database& database, std::int64_t variant, std::uint64_t seed);

[[nodiscard]] StoredCampaign read_campaign(SQLite::Database& database);
void insert_campaign(SQLite::Database& database, const StoredCampaign& campaign);

/// By position.
[[nodiscard]] std::vector<StoredVariant> read_variants(SQLite::Database& database);
void insert_variant(SQLite::Database& database, const StoredVariant& variant,
                    std::int64_t position);

}  // namespace qsmpc::harness
