// docs/contest.md and the reader agree, and shipped contests are valid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/shipped_files.hpp"
#include "tests/unit/contest/contest_fixture.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace contest_documentation_test {

TEST(ContestDocumentation, its_example_is_a_contest) {
  const std::string text = content_of(std::string(QSMPC_SOURCE_DIR) + "/docs/contest.md");
  const std::string fence = "```yaml\n";
  const std::size_t begin = text.find(fence) + fence.size();
  const testing::TemporaryFolder folder;
  (void)folder.file("my_scenario.yaml", to_yaml(testing::quick_scenario()));
  const std::string file =
      folder.file("blocks.yaml", text.substr(begin, text.find("```", begin) - begin));
  const LoadedContest loaded = load_contest(folder.file(
      "blocks.yaml", content_of(file).replace(content_of(file).find(", mujoco]"), 8, "")));
  EXPECT_EQ(loaded.contest.name, "blocks");
  EXPECT_EQ(loaded.drives.episodes(), 3 * 2 * 1 * 2 * 200);
  EXPECT_EQ(loaded.search.episodes(), (4 + 3) * 2 * 1 * 2 * 10);
}

TEST(ContestDocumentation, shipped_contests_are_valid_and_described) {
  const std::vector<ShippedContest> contests = shipped_contests();
  ASSERT_FALSE(contests.empty());
  for (const ShippedContest& contest : contests) {
    SCOPED_TRACE(contest.name);
    EXPECT_FALSE(contest.description.empty());
    EXPECT_TRUE(is_contest_file(contest.name));
    const LoadedContest loaded = load_contest(contest.name);
    EXPECT_EQ(loaded.contest.name, contest.name);
    EXPECT_TRUE(loaded.contest.tuning) << "a fair contest has a search";
  }
}

}  // namespace contest_documentation_test
}  // namespace qsmpc::harness
