// The controller examples, run as their pages describe.
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::testing {
namespace example_controllers_test {

const std::string kExamples = std::string(QSMPC_SOURCE_DIR) + "/examples/";

/// The summary of an example's drive on the model itself; the drive must arrive.
nlohmann::json drive(const std::string& example, const std::vector<std::string>& settings) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"run",        kExamples + example + "/scenario.yaml",
                                        "--no-video", "--quiet",
                                        "--out",      folder / "out",
                                        "--set",      "plant.kind=analytic"};
  for (const std::string& setting : settings) {
    arguments.emplace_back("--set");
    arguments.push_back(setting);
  }
  const ProcessResult result = run_qsmpc(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  auto summary = nlohmann::json::parse(read_text(folder / "out/summary.json"), nullptr, false);
  EXPECT_EQ(summary["outcome"], "reached") << read_text(folder / "out/controller.log");
  return summary;
}

TEST(Examples, pure_pursuit_in_python_arrives) {
  const auto summary = drive("pure_pursuit_python", {});
  EXPECT_LT(summary["certificate"]["next_step"]["max"], 1e-3);
  EXPECT_GT(summary["min_clearance"], 0.3);
}

/// The same with a Python program and its PyPI packages.
nlohmann::json drive_in_python(const std::string& example, const std::string& program,
                               std::vector<std::string> settings = {}) {
  const std::string python = std::string(QSMPC_BINARY_DIR) + "/tests/examples/venv/bin/python3";
  settings.push_back("controller.command=[" + python + ", " + kExamples + example + "/" + program +
                     "]");
  // Tests run in parallel and share the cores.
  settings.emplace_back("controller.deadline=100");
  return drive(example, settings);
}

TEST(Examples, scenario_mpc_with_casadi_arrives_with_plans_within_the_limit) {
  const auto summary = drive_in_python("casadi_scenario_mpc", "scenario_mpc.py");
  EXPECT_LT(summary["certificate"]["next_step"]["max"], 0.05);
  EXPECT_LE(summary["risk"]["plan"]["certified_max"], 0.02);
}

TEST(Examples, scenario_mpc_with_casadi_says_which_systems_it_knows) {
  const TemporaryFolder folder;
  const std::string python = std::string(QSMPC_BINARY_DIR) + "/tests/examples/venv/bin/python3";
  const ProcessResult result =
      run_qsmpc({"run", "cart_pole", "--no-video", "--quiet", "--out", folder / "out", "--set",
                 "plant.kind=analytic", "--set", "controller.kind=external", "--set",
                 "controller.plans=true", "--set",
                 "controller.command=[" + python + ", " + kExamples +
                     "casadi_scenario_mpc/scenario_mpc.py]"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.errors + result.output,
              ::testing::HasSubstr("system cart_pole, expected one of dubins, "));
}

TEST(Examples, multi_stage_mpc_with_do_mpc_arrives_with_certified_plans) {
  const auto summary = drive_in_python("do_mpc_multi_stage", "multi_stage.py");
  EXPECT_LT(summary["certificate"]["next_step"]["max"], 0.05);
  EXPECT_TRUE(summary["certificate"]["horizon"]["max"].is_number());
}

TEST(Examples, mpc_in_cpp_builds_outside_of_the_tree_and_arrives_with_certified_plans) {
  const TemporaryFolder folder;
  // A folder with the headers laid out as when installed.
  const std::string source = QSMPC_SOURCE_DIR;
  const std::string command = "mkdir -p '" + folder / "include" + "' && ln -s '" + source + "' '" +
                              (folder / "include/qsmpc") + "' && cmake -S '" + kExamples +
                              "cpp_mpc' -B '" + (folder / "build") + "' -D QSMPC_INCLUDE_DIR='" +
                              (folder / "include") + "' -D CMAKE_CXX_FLAGS='-I" + source + "' > '" +
                              (folder / "log") + "' 2>&1 && cmake --build '" + (folder / "build") +
                              "' >> '" + (folder / "log") + "' 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << read_text(folder / "log");
  const auto summary = drive("cpp_mpc", {"controller.library=" + (folder / "build/mpc.so")});
  EXPECT_LT(summary["certificate"]["next_step"]["max"], 0.5);
  EXPECT_TRUE(summary["certificate"]["horizon"]["max"].is_number());
}

}  // namespace example_controllers_test
}  // namespace qsmpc::testing
