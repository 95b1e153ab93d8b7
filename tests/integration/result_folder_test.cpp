// A folder that already holds a result: the same one is replaced, a different one only with
// --force.

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/trace/trace_file.hpp"
#include "tests/integration/campaign_fixture.hpp"
#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace result_folder_test {

using namespace testing;

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// A command that is quick, with `more` arguments.
std::vector<std::string> quick(const std::string& command, const std::string& out,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {
      command,
      "dubins_corridor",
      "--quiet",
      "--set",
      "limit.steps=2",
      "--set",
      "controller.quantisation={state: 27, noise: 16, compressed: 27}"};
  if (!out.empty()) arguments.insert(arguments.end(), {"--out", out});
  if (command == "run") arguments.insert(arguments.end(), {"--no-video", "--fail-on", "none"});
  if (command == "compare") {
    arguments.insert(arguments.end(), {"--episodes", "1", "--paths", "10", "--plant", "analytic"});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

struct Command {
  const char* name;
  const char* result;  // one of its files
};

class ResultFolder : public ::testing::TestWithParam<Command> {};

TEST_P(ResultFolder, replaces_another_scenarios_result_only_where_it_is_forced_to) {
  const auto& [name, result] = GetParam();
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(run_qsmpc(quick(name, out)).exit_code, 0);
  const std::string before = read_text(out + "/" + result);
  const std::string scenario = read_text(out + "/scenario.yaml");
  ASSERT_FALSE(before.empty());
  EXPECT_EQ(run_qsmpc(quick(name, out)).exit_code, 0) << "the same result again";

  const std::string kept = read_text(out + "/" + result);
  const std::vector<std::string> other = {"--set", "controller.horizon=5", "--seed", "7"};
  const ProcessResult refused = run_qsmpc(quick(name, out, other));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.output, "");
  EXPECT_EQ(refused.errors,
            "qsmpc: " + out +
                ": found the result of another scenario: controller.horizon is 8 there, 5 here, "
                "and 1 more key differs, expected another --out, or --force to replace it\n");
  EXPECT_EQ(read_text(out + "/" + result), kept);
  EXPECT_EQ(read_text(out + "/scenario.yaml"), scenario);

  std::vector<std::string> forced = other;
  forced.emplace_back("--force");
  EXPECT_EQ(run_qsmpc(quick(name, out, forced)).exit_code, 0);
  EXPECT_NE(read_text(out + "/" + result), kept);
  EXPECT_THAT(read_text(out + "/scenario.yaml"), HasSubstr("horizon: 5"));
}

INSTANTIATE_TEST_SUITE_P(Commands, ResultFolder,
                         ::testing::Values(Command{"run", "episode.h5"},
                                           Command{"predict", "predict.json"},
                                           Command{"compare", "comparison.json"}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(ResultFolders, the_default_one_is_looked_at_as_well) {
  const TemporaryFolder folder;
  const ProcessOptions here{.folder = folder.path()};
  const auto drive = [&](const char* mean) {
    const std::string file = folder.file(
        "mine.yaml", std::string("name: mine\nmodel: {system: dubins}\nplant: {kind: analytic}\n"
                                 "target: {state: [5, 0, 0]}\nlimit: {steps: 1}\n"
                                 "initial_state: {mean: ") +
                         mean + "}\n");
    return run_qsmpc({"run", file, "--no-video", "--quiet"}, here);
  };
  EXPECT_EQ(drive("[0, 0, 0]").exit_code, 0);
  EXPECT_EQ(drive("[0, 0, 0.0]").exit_code, 0) << "another text for the same scenario";
  const ProcessResult other = drive("[0, 0, 0.5]");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.errors, HasSubstr("out/mine-0: found the result of another scenario: "
                                      "initial_state.mean is [0, 0, 0] there, [0, 0, 0.5] here"));
}

TEST(ResultFolders, what_a_scenario_is_called_makes_no_other_result) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_qsmpc(quick("run", folder / "out")).exit_code, 0);
  EXPECT_EQ(run_qsmpc(quick("run", folder / "out", {"--set", "name=\"renamed\""})).exit_code, 0);
}

TEST(ResultFolders, one_with_a_foreign_scenario_file_or_a_campaign_is_refused) {
  const TemporaryFolder folder;
  const std::string mine = "# mine\nmodel: {system: dubins\n";
  (void)folder.file("scenario.yaml", mine);
  const ProcessResult foreign = run_qsmpc(quick("run", folder.path()));
  EXPECT_EQ(foreign.exit_code, 2);
  EXPECT_THAT(foreign.errors, HasSubstr("found a scenario.yaml that is not a resolved scenario"));
  EXPECT_EQ(read_text(folder / "scenario.yaml"), mine);

  const TemporaryFolder store;
  (void)store.file("campaign.sqlite", "");
  const ProcessResult campaign = run_qsmpc(quick("run", store.path()));
  EXPECT_EQ(campaign.exit_code, 2);
  EXPECT_THAT(campaign.errors, HasSubstr("found the results of a campaign"));
  EXPECT_EQ(files_in(store.path()).size(), 1U);
}

}  // namespace result_folder_test
}  // namespace qsmpc::harness
