// The file of a store: what is none, what is damaged, and what an earlier version made.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(refusal(testing::quick_campaign()), HasSubstr("an SQLite file of another program"));
  EXPECT_THROW(StoreReader(folder.path()), InputError);
}

TEST_F(StoreFileTest, refuses_a_file_that_is_no_database) {
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
  for (const std::string table : {"episode", "episode_timing", "period", "period_timing"}) {
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

TEST_F(StoreFileTest, a_checksum_whose_episode_is_gone_is_seen) {
  open(testing::quick_campaign()).add(testing::example_row(0, 7), false);
  database().exec("DELETE FROM episode");
  EXPECT_THROW(StoreReader(folder.path()).verify(), IoError);
}

/// A store as the first schema had it, with one episode.
void make_first_store(const std::string& path) {
  SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  migrate(database, 0, {store_migrations().front()});
  const Campaign campaign = testing::quick_campaign();
  database.exec(fmt::format(
      "INSERT INTO campaign VALUES (1, 'quick', '{}', '5 to 8', 'none', 1, 1, 8)", kVersion));
  for (const StoredVariant& variant : stored_variants(campaign, {"", ""})) {
    insert_variant(database, variant, variant.id);
  }
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

TEST(StoreMigration, applies_what_is_missing_one_whole_step_at_a_time) {
  SQLite::Database database(":memory:", SQLite::OPEN_READWRITE);
  const std::vector<std::string> steps{
      "CREATE TABLE t (a)", "ALTER TABLE t ADD COLUMN b",
      "INSERT INTO t VALUES (1, 2); INSERT INTO missing VALUES (1)"};
  migrate(database, 0, {steps[0]});
  database.exec("INSERT INTO t VALUES (7)");
  EXPECT_THROW(migrate(database, 1, steps), SQLite::Exception);
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), 2);
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM t").getInt(), 1);
  EXPECT_EQ(database.execAndGet("SELECT a FROM t WHERE b IS NULL").getInt(), 7);
}

}  // namespace store_file_test
}  // namespace qsmpc::harness
