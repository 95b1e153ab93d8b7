// External controllers, run by the program: exit codes, files, campaigns, interrupts.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/campaign_fixture.hpp"
#include "tests/integration/process.hpp"

namespace qsmpc::testing {
namespace outside_controller_test {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kData = std::string(QSMPC_SOURCE_DIR) + "/tests/data/controllers";
const std::string kBuilt = std::string(QSMPC_BINARY_DIR) + "/tests/controllers";

/// A scenario in `folder` driven by the responder, which lies beside it.
std::string scenario_in(const TemporaryFolder& folder, const std::string& options = "{}") {
  std::filesystem::copy(kData + "/responder.py", folder / "responder.py");
  return folder.file("mine.yaml",
                     "name: mine\n"
                     "model: {system: dubins}\n"
                     "plant: {kind: analytic, mjcf: \"\"}\n"
                     "initial_state: {mean: [0, 0, 0]}\n"
                     "disturbance: {covariance: [1e-4, 1e-4, 1e-4]}\n"
                     "target: {state: [50, 0, 0]}\n"
                     "controller:\n"
                     "  kind: external\n"
                     "  command: [python3, responder.py]\n"
                     "  quantisation: {state: 10, noise: 10, compressed: 10}\n"
                     "  options: " +
                         options + "\nlimit: {steps: 5}\n");
}

nlohmann::json summary_in(const std::string& folder) {
  return nlohmann::json::parse(read_text(folder + "/summary.json"));
}

TEST(OutsideController, stands_beside_its_scenario_and_is_found_from_anywhere) {
  const TemporaryFolder folder;
  const std::string scenario = scenario_in(folder);
  const std::string out = folder / "out";
  const ProcessResult first =
      run_qsmpc({"run", scenario, "--no-video", "--seed", "3", "--out", out}, {.folder = "/"});
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_EQ(summary_in(out)["controller"], "external");
  EXPECT_EQ(read_text(out + "/controller.log"), "controller of mine\ndrive 3\n");
  EXPECT_THAT(read_text(out + "/report.html"), HasSubstr("external, python3 responder.py"));
  // The resolved scenario gives the same drive.
  const ProcessResult again = run_qsmpc(
      {"run", out + "/scenario.yaml", "--no-video", "--out", folder / "again"}, {.folder = "/tmp"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(read_text(folder / "again" + "/scenario.yaml"), read_text(out + "/scenario.yaml"));
  EXPECT_EQ(summary_in(folder / "again")["cost"], summary_in(out)["cost"]);
  for (const char* command : {"report", "validate"}) {
    const std::string what = command == std::string("report") ? out : folder / "mine.yaml";
    EXPECT_EQ(run_qsmpc({command, what}).exit_code, 0) << command;
  }
}

TEST(OutsideController, is_named_on_the_command_line_from_the_working_folder) {
  const TemporaryFolder folder;
  (void)scenario_in(folder);
  const ProcessResult result =
      run_qsmpc({"run", "dubins_obstacles", "--no-video", "--out", folder / "out", "--set",
                 "limit.steps=3", "--set", "plant.kind=analytic", "--set",
                 "controller.kind=external", "--set", "controller.command=[python3, responder.py]"},
                {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST(OutsideController, that_fails_is_reported_in_one_line_with_code_1) {
  const TemporaryFolder folder;
  const std::string scenario = scenario_in(folder, "{mode: exit}");
  const ProcessResult result =
      run_qsmpc({"run", scenario, "--no-video", "--quiet", "--out", folder / "out"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors,
              HasSubstr("qsmpc: the controller failed: controller python3 responder.py: period 2: "
                        "found an exit with code 7 after \"ZeroDivisionError: division by "
                        "zero\", expected an answer\n"));
  const auto summary = summary_in(folder / "out");
  EXPECT_EQ(summary["outcome"], "fault");
  EXPECT_EQ(summary["fault_of"], "controller");
  EXPECT_EQ(summary["steps"], 2);
  EXPECT_THAT(read_text(folder / "out/report.html"), HasSubstr("The controller failed after"));
  const ProcessResult predicted =
      run_qsmpc({"predict", folder.file("old.yaml", read_text(scenario) + "\n"), "--set",
                 "controller.options.mode=old", "--out", folder / "p", "--quiet"});
  EXPECT_EQ(predicted.exit_code, 2);
  EXPECT_THAT(predicted.errors, HasSubstr("found version 7 of the protocol, expected version 1"));
}

TEST(OutsideController, that_is_not_there_is_refused_before_anything_is_driven) {
  const TemporaryFolder folder;
  const std::string scenario = scenario_in(folder);
  const auto refusal = [&](const std::string& setting) {
    const ProcessResult result =
        run_qsmpc({"run", scenario, "--no-video", "--out", folder / "out", "--set", setting});
    EXPECT_EQ(result.exit_code, 2) << setting;
    return result.errors;
  };
  EXPECT_THAT(refusal("controller.command=[no_such_program]"), HasSubstr("no_such_program"));
  EXPECT_THAT(refusal("controller.command=[]"), HasSubstr("controller.command"));
  EXPECT_THAT(refusal("controller.folder=/no/such"), HasSubstr("controller.folder"));
  EXPECT_THAT(refusal("controller.kind=library"), HasSubstr("controller.library"));
  EXPECT_THAT(refusal("controller.options={a: .inf}"), HasSubstr("controller.options"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

/// The failing variants end as faults, the others complete; the same with any number of jobs.
TEST(OutsideController, in_campaigns_fails_alone_and_the_campaign_continues) {
  const TemporaryFolder folder;
  (void)scenario_in(folder);
  const std::string campaign =
      folder.file("campaign.yaml",
                  "name: outside\nscenario: mine.yaml\ntraces: failures\n"
                  "variants:\n"
                  "  good: {}\n"
                  "  crashes: {controller.options.mode: crash}\n"
                  "  hangs: {controller.options.mode: hang, controller.deadline: 1}\n"
                  "  lies: {controller.options.mode: nan}\n"
                  "  library: {controller.kind: library, controller.library: " +
                      kBuilt +
                      "/library.so}\n"
                      "  class: {controller.kind: library, controller.library: " +
                      kBuilt +
                      "/own.so}\n"
                      "  broken: {controller.kind: library, controller.library: " +
                      kBuilt +
                      "/own.so, "
                      "controller.options.mode: crash}\n"
                      "  ours: {controller.kind: lqr}\n"
                      "seeds: {first: 1, count: 3}\n");
  std::vector<nlohmann::json> costs;
  for (const char* jobs : {"1", "3"}) {
    const std::string out = folder / jobs;
    const ProcessResult result =
        run_qsmpc({"campaign", campaign, "--jobs", jobs, "--quiet", "--json", "--out", out});
    EXPECT_EQ(result.exit_code, 1) << result.errors;  // because of the faults
    const auto json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["done"], 24);
    EXPECT_EQ(json["outcomes"]["fault"], 12);
    EXPECT_EQ(json["variants"]["good"]["outcomes"]["timeout"], 3);
    EXPECT_EQ(json["variants"]["hangs"]["outcomes"]["fault"], 3);
    EXPECT_THAT(read_text(out + "/episodes.csv"), HasSubstr("signal 11 (Segmentation fault)"));
    // Traces of the failed episodes as well, and a log of every controller that printed something.
    EXPECT_EQ(files_below(out, "episode.h5").size(), 24U);
    EXPECT_GE(files_below(out, "controller.log").size(), 12U);
    costs.push_back(json["variants"]["good"]["cost"]);
    costs.push_back(json["variants"]["class"]["cost"]);
  }
  EXPECT_EQ(costs[0], costs[2]);
  EXPECT_EQ(costs[1], costs[3]);
}

TEST(OutsideController, is_compared_on_its_plants_as_any_other) {
  const TemporaryFolder folder;
  const std::string scenario = scenario_in(folder);
  const ProcessResult result =
      run_qsmpc({"compare", scenario, "--plant", "analytic", "--episodes", "3", "--paths", "100",
                 "--threads", "2", "--quiet", "--json", "--out", folder / "out", "--set",
                 "controller.plans=true", "--set", "controller.horizon=3"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["plants"]["analytic"]["episodes"], 3);
}

TEST(OutsideController, that_hangs_does_not_block_ctrl_c) {
  const TemporaryFolder folder;
  const std::string pids = folder / "pids";
  const std::string scenario = scenario_in(folder, "{mode: hang, pids: " + pids + "}");
  const ProcessResult result =
      run_qsmpc({"run", scenario, "--no-video", "--quiet", "--out", folder / "out", "--set",
                 "controller.deadline=1000"},
                {.meanwhile = [&](pid_t program) {
                  // It hangs in period 2, after the log line about the drive.
                  if (!std::filesystem::exists(folder / "out/episode.h5.partial")) return false;
                  if (read_text(pids).empty()) return false;
                  kill(program, SIGINT);
                  return true;
                }});
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_EQ(summary_in(folder / "out")["outcome"], "interrupted");
  std::ifstream file(pids);
  for (pid_t process = 0; file >> process;) EXPECT_NE(kill(process, 0), 0);
}

}  // namespace outside_controller_test
}  // namespace qsmpc::testing
