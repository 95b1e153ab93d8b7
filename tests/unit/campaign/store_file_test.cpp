// A store's file: not a store, damaged, or made by an earlier version.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/campaign/store/store_checksum.hpp"
#include "harness/campaign/store/store_rows.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "harness/version.hpp"
#include "tests/unit/campaign/store_fixture.hpp"

namespace qsmpc::harness {
namespace store_file_test {

using ::testing::HasSubstr;
using StoreFileTest = testing::StoreFolder;

TEST_F(StoreFileTest, refuses_a_newer_schema_and_leaves_the_file_as_it_is) {
  open(testing::quick_campaign()).fold();
  database().exec("PRAGMA user_version = 99");
  const auto size = std::filesystem::file_size(path());
  EXPECT_THAT(refusal(testing::quick_campaign()), HasSubstr("schema 99, made by a newer qsmpc"));
  EXPECT_THROW(StoreReader(folder.path()), InputError);
  EXPECT_EQ(std::filesystem::file_size(path()), size);
  EXPECT_EQ(database().execAndGet("PRAGMA user_version").getInt(), 99);
}

TEST_F(StoreFileTest, refuses_the_file_of_another_program) {
  {
    SQLite::Database(path(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec("CREATE TABLE t (x)");
  }
  EXPECT_THAT(refusal(testing::quick_campaign()), HasSubstr("an SQLite file from another program"));
  EXPECT_THROW(StoreReader(folder.path()), InputError);
}

TEST_F(StoreFileTest, refuses_a_file_that_is_not_a_database) {
  std::ofstream(path()) << std::string(5000, 'x');
  EXPECT_THROW(open(testing::quick_campaign()), IoError);
  EXPECT_THROW(StoreReader(folder.path()), IoError);
}

TEST_F(StoreFileTest, a_reader_refuses_a_folder_without_a_store) {
  EXPECT_THROW(StoreReader(folder.path()), InputError);
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(StoreFileTest, a_change_of_any_column_of_an_episode_is_seen) {
  open(testing::quick_campaign()).add(testing::example_row(0, 7), false);
  EXPECT_NO_THROW(StoreReader(folder.path()).verify());
  const std::string before = content();
  for (const std::string table :
       {"episode", "episode_timing", "episode_periods", "episode_ocp_ms"}) {
    std::vector<std::string> columns;
    {
      SQLite::Database store = database();
      SQLite::Statement info(store, "SELECT name FROM pragma_table_info(?)");
      info.bind(1, table);
      while (info.executeStep()) columns.push_back(info.getColumn(0).getString());
    }
    for (const std::string& column : columns) {
      database().exec("UPDATE " + table + " SET " + column + " = CASE WHEN typeof(" + column +
                      ") = 'text' THEN " + column + " || '.' ELSE -coalesce(" + column +
                      ", 1) - 1 END");
      EXPECT_THROW(StoreReader(folder.path()).verify(), IoError) << table << "." << column;
      std::ofstream(path(), std::ios::binary) << before;
      EXPECT_NO_THROW(StoreReader(folder.path()).verify()) << "as it was";
    }
  }
}

TEST_F(StoreFileTest, the_first_damaged_episode_is_found_by_any_number_of_threads) {
  constexpr std::int64_t kEpisodes = 300;
  {
    Store store = open(testing::quick_campaign());
    for (std::int64_t seed = 0; seed < kEpisodes; ++seed) {
      store.add(testing::example_row(seed % 2, static_cast<std::uint64_t>(seed)), false);
    }
  }
  const auto found = [&](int threads) {
    const std::optional<StoredEpisode> episode = damaged_episode(path(), threads);
    return episode ? fmt::format("{}, {}", episode->variant, episode->seed) : "none";
  };
  for (const int threads : {1, 2, 3, 8}) EXPECT_EQ(found(threads), "none");
  // Each is in another block of seeds and comes before those of the line above.
  for (const auto& [variant, seed] : {std::pair{1, 299}, {1, 129}, {0, 298}, {0, 200}, {0, 2}}) {
    database().exec(fmt::format(
        "UPDATE episode SET cost = cost + 1 WHERE variant = {} AND seed = {}", variant, seed));
    for (const int threads : {1, 2, 3, 8}) {
      EXPECT_EQ(found(threads), fmt::format("{}, {}", variant, seed)) << threads << " threads";
    }
  }
}

TEST_F(StoreFileTest, a_checksum_whose_episode_is_gone_is_seen) {
  open(testing::quick_campaign()).add(testing::example_row(0, 7), false);
  database().exec("DELETE FROM episode");
  EXPECT_THROW(StoreReader(folder.path()).verify(), IoError);
}

/// An empty store with schema version `schema`.
void make_old_store(const std::string& path, std::size_t schema) {
  SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  const std::vector<Migration>& all = store_migrations();
  migrate(database, 0, {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(schema)});
  database.exec(fmt::format(
      "INSERT INTO campaign VALUES (1, 'quick', '{}', '5 to 8', 'none', 1, 1, 8)", kVersion));
  for (const StoredVariant& variant : stored_variants(testing::quick_campaign(), {"", ""})) {
    insert_variant(database, variant, variant.id);
  }
}

/// A store of the first schema version with one episode.
void make_first_store(const std::string& path) {
  make_old_store(path, 1);
  SQLite::Database database(path, SQLite::OPEN_READWRITE);
  database.exec(
      "INSERT INTO episode VALUES (1, 6, 'reached', '', 2, 0.2, 0, 1.5, 9.0, 0, 0, 0, 0, 1, 0, '');"
      "INSERT INTO episode_timing VALUES (1, 6, 1e9, 2.0, 0);"
      "INSERT INTO period VALUES (1, 6, 0, 0.1, 0.2, 0);"
      "INSERT INTO period_timing VALUES (1, 6, 0, 0.5)");
}

TEST_F(StoreFileTest, of_an_older_schema_is_brought_up_to_date_with_its_episodes) {
  make_first_store(path());
  EXPECT_THROW(StoreReader(folder.path()), InputError);
  EXPECT_EQ(open(testing::quick_campaign()).outcome(1, 6), "reached");
  EXPECT_EQ(database().execAndGet("PRAGMA user_version").getInt(), store_schema());
  const std::vector<EpisodeRow> rows = rows_of(1);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_NO_THROW(StoreReader(folder.path()).verify());
  EXPECT_EQ(rows[0].cost, 9.0);
  EXPECT_EQ(rows[0].risk_exceeded, std::nullopt);
  EXPECT_EQ(rows[0].version, StoreReader(folder.path()).campaign().version);
}

TEST_F(StoreFileTest, periods_of_an_older_schema_keep_their_numbers_and_checksums) {
  // The checksum is the one written by the version with this schema.
  make_old_store(path(), 6);
  {
    SQLite::Database store = database();
    store.exec(
        "INSERT INTO episode VALUES (1, 6, 'collision', '', 3, NULL, 1, -0.5, 9.0, 0.1, 0.2, 0.3, "
        "NULL, 1, 0, '', '1.2', 0, NULL, 0.25);"
        "INSERT INTO episode_timing VALUES (1, 6, 1e9, 2.0, 0);"
        "INSERT INTO period VALUES (1, 6, 0, 0.1, 0.30000000000000004, 0), (1, 6, 1, 1e-300, NULL, "
        "1), (1, 6, 2, 9e999, 0, 1);"
        "INSERT INTO period_timing VALUES (1, 6, 0, 0.5), (1, 6, 1, 1e-9), (1, 6, 2, 3);"
        "INSERT INTO episode_checksum VALUES (1, 6, 1155249623647164558)");
  }
  (void)open(testing::quick_campaign());
  std::vector<PeriodRow> periods;
  const StoreReader store(folder.path());
  store.for_each_period(1, [&](std::uint64_t seed, std::int64_t period, const PeriodRow& row) {
    EXPECT_EQ(seed, 6U);
    EXPECT_EQ(period, std::ssize(periods));
    periods.push_back(row);
  });
  ASSERT_EQ(periods.size(), 3U);
  EXPECT_EQ(periods[0].certified, 0.1);
  EXPECT_EQ(periods[0].published, 0.30000000000000004);
  EXPECT_EQ(periods[1].certified, 1e-300);
  EXPECT_TRUE(std::isnan(periods[1].published));
  EXPECT_EQ(periods[2].certified, std::numeric_limits<double>::infinity());
  EXPECT_EQ(periods[2].published, 0.0);
  EXPECT_FALSE(periods[0].unsafe);
  EXPECT_TRUE(periods[1].unsafe);
  EXPECT_EQ(periods[1].ocp_ms, 1e-9);
  EXPECT_EQ(periods[2].ocp_ms, 3.0);
  EXPECT_NO_THROW(store.verify());
  // Reading the former tables by SQL still gives their contents.
  SQLite::Database sql = database();
  EXPECT_EQ(sql.execAndGet("SELECT certified FROM period WHERE period = 0").getDouble(), 0.1);
  EXPECT_EQ(sql.execAndGet("SELECT sum(unsafe) FROM period WHERE seed = 6").getInt(), 2);
  EXPECT_TRUE(sql.execAndGet("SELECT published FROM period WHERE period = 1").isNull());
  EXPECT_EQ(sql.execAndGet("SELECT ocp_ms FROM period_timing WHERE period = 2").getDouble(), 3.0);
}

TEST(StoreMigration, applies_what_is_missing_one_whole_step_at_a_time) {
  SQLite::Database database(":memory:", SQLite::OPEN_READWRITE);
  const std::vector<Migration> steps{
      {.sql = "CREATE TABLE t (a)"},
      {.sql = "ALTER TABLE t ADD COLUMN b"},
      {.sql = "INSERT INTO t VALUES (1, 2)", .after = "INSERT INTO missing VALUES (1)"}};
  migrate(database, 0, {steps[0]});
  database.exec("INSERT INTO t VALUES (7)");
  EXPECT_THROW(migrate(database, 1, steps), SQLite::Exception);
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), 2);
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM t").getInt(), 1);
  EXPECT_EQ(database.execAndGet("SELECT a FROM t WHERE b IS NULL").getInt(), 7);
}

}  // namespace store_file_test
}  // namespace qsmpc::harness
