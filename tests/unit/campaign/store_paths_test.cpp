#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "harness/campaign/store/store.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace store_paths_test {

TEST(StorePaths, gives_back_the_paths_of_failures_before_others_and_of_no_more_than_asked_for) {
  const testing::TemporaryFolder folder;
  const Campaign campaign = testing::quick_campaign();
  const Shard whole{};
  Store store(folder.path(), stored_campaign(campaign, whole), stored_variants(campaign, {"", ""}),
              campaign.seeds, false);
  for (const auto& [seed, outcome] : {std::pair{5, "reached"}, {6, "collision"}, {7, "reached"}}) {
    EpisodeRow row = testing::example_row(0, static_cast<std::uint64_t>(seed), outcome);
    row.path = {{.x = 0.0, .y = -1.25}, {.x = 1.0 * seed, .y = 1e-7}};
    store.add(row, false);
  }
  store.add(testing::example_row(0, 8), false);  // without a path
  const auto paths = [&](std::int64_t most) {
    std::vector<std::pair<std::string, std::vector<PathPoint>>> found;
    StoreReader(folder.path())
        .for_each_path(0, most, [&](const std::string& outcome, const auto& path) {
          found.emplace_back(outcome, path);
        });
    return found;
  };
  ASSERT_EQ(paths(10).size(), 3U);
  EXPECT_EQ(paths(10)[0].first, "collision");
  EXPECT_EQ(paths(10)[0].second,
            (std::vector<PathPoint>{{.x = 0.0, .y = -1.25}, {.x = 6.0, .y = 1e-7}}));
  EXPECT_EQ(paths(10)[2].second[1].x, 7.0);
  EXPECT_EQ(paths(2).size(), 2U);
  store.add(testing::example_row(0, 6, "timeout"), true);  // replaced by one without a path
  EXPECT_EQ(paths(10).size(), 2U);
  SQLite::Database(folder.path() + "/" + kStoreFile, SQLite::OPEN_READWRITE)
      .exec("UPDATE path SET points = '[[0]]'");
  try {
    (void)paths(10);
    ADD_FAILURE() << "a path of one number was read";
  } catch (const IoError& error) {
    EXPECT_EQ(error.what(),
              folder.path() + "/" + kStoreFile + ": damaged: a path that is not a list of points");
  }
}

}  // namespace store_paths_test
}  // namespace qsmpc::harness
