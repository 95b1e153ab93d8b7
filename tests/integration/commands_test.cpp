// Commands that drive nothing: output and exit codes.

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace commands_test {

using namespace testing;

using ::testing::HasSubstr;

constexpr const char* kValid =
    "name: a\nmodel: {system: dubins}\ninitial_state: {mean: [0, 0, 0]}\n"
    "target: {state: [1, 0, 0]}\n";

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Commands, list_and_validate_and_help) {
  EXPECT_THAT(run_qsmpc({"list"}).output, HasSubstr("dubins_obstacles"));
  EXPECT_THAT(run_qsmpc({"list", "systems", "--json"}).output, HasSubstr("\"dubins\""));
  EXPECT_THAT(run_qsmpc({"list", "propagators"}).output, HasSubstr("moment_matched"));
  EXPECT_THAT(run_qsmpc({"list", "boundings"}).output, HasSubstr("sigmoid"));
  EXPECT_THAT(run_qsmpc({"list", "quantisers"}).output, HasSubstr("lloyd"));
  EXPECT_THAT(run_qsmpc({"list", "methods"}).output, HasSubstr("gaussian_mixture"));
  EXPECT_EQ(run_qsmpc({"list", "wheels"}).exit_code, 2);
  EXPECT_EQ(run_qsmpc({"validate", "dubins_obstacles"}).exit_code, 0);
  for (const char* command : {"run", "predict", "render", "report", "list", "validate"}) {
    const ProcessResult help = run_qsmpc({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.output, HasSubstr("Example"));
  }
  const TemporaryFolder folder;
  const std::string file =
      folder.file("two.yaml", std::string(kValid) + "horizon: 3\ntime_step: 0\n");
  const ProcessResult invalid = run_qsmpc({"validate", file, "--json"});
  EXPECT_EQ(invalid.exit_code, 2);
  const auto json = nlohmann::json::parse(invalid.output);
  EXPECT_EQ(json["ok"], false);
  EXPECT_EQ(json["errors"].size(), 2U);
  EXPECT_EQ(json["errors"][0]["line"], 5);
}

TEST(Commands, validate_takes_the_settings_that_run_takes) {
  EXPECT_EQ(run_qsmpc({"validate", "dubins_obstacles", "--set", "controller.horizon=9"}).exit_code,
            0);
  const ProcessResult wrong =
      run_qsmpc({"validate", "dubins_obstacles", "--set", "controller.horizon=0"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.output, HasSubstr("controller.horizon"));
  const ProcessResult plant =
      run_qsmpc({"validate", "dubins_obstacles", "--set", "plant.mjcf=nowhere.xml"});
  EXPECT_EQ(plant.exit_code, 2);
  EXPECT_THAT(plant.output, HasSubstr("nowhere.xml"));
  const ProcessResult campaign = run_qsmpc(
      {"validate", "mission_budget", "dubins_obstacles", "--set", "controller.horizon=9"});
  EXPECT_EQ(campaign.exit_code, 2);
  EXPECT_THAT(campaign.output, HasSubstr("found a campaign or a contest, expected a scenario"));
  EXPECT_THAT(campaign.output, HasSubstr("dubins_obstacles: ok"));
}

TEST(Commands, warn_of_limits_that_the_start_exceeds) {
  const TemporaryFolder folder;
  const std::string file = folder.file(
      "risky.yaml", std::string(kValid) +
                        "plant: {kind: analytic, mjcf: \"\"}\nsafe_set: {bounds: {x: [-0.1, 20]}}\n"
                        "risk: {plan: 0}\n");
  const ProcessResult text = run_qsmpc({"validate", file});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.output, HasSubstr("warning: risk.plan is 0"));
  EXPECT_THAT(text.output, HasSubstr(": ok\n"));
  const auto json = nlohmann::json::parse(run_qsmpc({"validate", file, "--json"}).output);
  EXPECT_EQ(json["ok"], true);
  EXPECT_EQ(json["warnings"].size(), 1U);
  // One standard deviation from the wall.
  const ProcessResult run =
      run_qsmpc({"run", file, "--set", "limit.steps=1", "--set", "risk.plan=0.1", "--set",
                 "initial_state.covariance=[0.01, 0.01, 0.01]", "--no-video", "--quiet",
                 "--fail-on", "none", "--out", folder / "out"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("qsmpc: warning: the start is unsafe with a certified "
                                    "probability of up to 0.159, above the limit of 0.1\n"));
}

TEST(Commands, a_folder_without_a_trace_is_a_bad_input) {
  const TemporaryFolder folder;
  for (const char* command : {"render", "report"}) {
    const ProcessResult result = run_qsmpc({command, folder.path()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(lines(result.errors), 1) << result.errors;
  }
}

}  // namespace commands_test
}  // namespace qsmpc::harness
