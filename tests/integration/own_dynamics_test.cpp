// User-defined systems through the program: the examples, by equations and from libraries built
// outside the tree.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/trace/trace_file.hpp"
#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace own_dynamics_test {

using namespace testing;

using ::testing::HasSubstr;

const std::string examples = std::string(QSMPC_SOURCE_DIR) + "/examples/";

/// The library of an example, built in `folder` by its own CMakeLists.txt against the public
/// headers.
std::string built_library(const std::string& example, const std::string& folder) {
  const std::string command =
      "cmake -S '" + examples + example + "' -B '" + folder +
      "' -DCMAKE_BUILD_TYPE=Release -DQSMPC_INCLUDE_DIR='" + QSMPC_PUBLIC_HEADERS + "' > '" +
      folder + "/log' 2>&1 && cmake --build '" + folder + "' >> '" + folder + "/log' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << read_text(folder + "/log");  // NOLINT: fixed
  return folder + "/lib" + example + ".so";
}

ProcessResult run_example(const std::string& scenario, const std::string& out,
                          std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"run", examples + scenario, "--no-video", "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_qsmpc(arguments);
}

class OwnDynamics : public ::testing::TestWithParam<std::string> {};

TEST_P(OwnDynamics, drive_alike_by_equations_and_from_a_library_built_outside) {
  const TemporaryFolder folder;
  const std::string library = built_library(GetParam(), folder.path());
  const std::string by_equations = folder.path() + "/equations";
  const std::string in_cpp = folder.path() + "/cpp";
  const ProcessResult first = run_example(GetParam() + "/scenario.yaml", by_equations);
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const ProcessResult second =
      run_example(GetParam() + "/scenario_cpp.yaml", in_cpp, {"--set", "model.library=" + library});
  ASSERT_EQ(second.exit_code, 0) << second.errors;

  const Trace equations = read_trace(by_equations + "/episode.h5");
  const Trace cpp = read_trace(in_cpp + "/episode.h5");
  ASSERT_EQ(equations.steps.size(), cpp.steps.size());
  ASSERT_GT(equations.steps.size(), 20U);
  for (std::size_t i = 0; i < cpp.steps.size(); ++i) {
    const double gap =
        (equations.steps[i].plan_inputs - cpp.steps[i].plan_inputs).cwiseAbs().maxCoeff();
    EXPECT_LE(gap, 1e-9) << "period " << i;
  }
  const auto summary = nlohmann::json::parse(read_text(in_cpp + "/summary.json"));
  EXPECT_EQ(summary["outcome"], "reached");
  EXPECT_LT(summary["certificate"]["next_step"]["mean"], 0.5);

  // The results are read without the library, and driven again with it.
  const ProcessResult again = run_qsmpc(
      {"run", in_cpp + "/scenario.yaml", "--no-video", "--out", folder.path() + "/again"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(read_text(folder.path() + "/again/scenario.yaml"),
            read_text(in_cpp + "/scenario.yaml"));
  const std::string compared = folder.path() + "/compared";
  const ProcessResult comparison =
      run_qsmpc({"compare", in_cpp + "/scenario.yaml", "--plant", "analytic", "--episodes", "2",
                 "--set", "limit.steps=3", "--out", compared});
  EXPECT_EQ(comparison.exit_code, 0) << comparison.errors;
  const std::string campaign = folder.path() + "/campaign.yaml";
  std::ofstream(campaign) << "name: two\nscenario: " << in_cpp << "/scenario.yaml\n"
                          << "variants: {short: {limit.steps: 3}}\nseeds: {count: 2}\n";
  const std::string driven = folder.path() + "/driven";
  const ProcessResult drives = run_qsmpc({"campaign", campaign, "--out", driven});
  EXPECT_EQ(drives.exit_code, 0) << drives.errors;
  std::filesystem::remove(library);
  for (const std::string& results : {in_cpp, compared, driven}) {
    const ProcessResult report = run_qsmpc({"report", results});
    EXPECT_EQ(report.exit_code, 0) << results << ": " << report.errors;
  }
  const ProcessResult gone =
      run_qsmpc({"run", in_cpp + "/scenario.yaml", "--no-video", "--out", folder.path() + "/gone"});
  EXPECT_EQ(gone.exit_code, 2);
  EXPECT_THAT(gone.errors, HasSubstr("model.library: found no file"));
}

std::string name_of(const ::testing::TestParamInfo<std::string>& info) { return info.param; }

INSTANTIATE_TEST_SUITE_P(Examples, OwnDynamics,
                         ::testing::Values("lag_unicycle", "planar_quadrotor"), name_of);

TEST(OwnDynamicsCommands, take_a_system_by_equations) {
  const TemporaryFolder folder;
  const std::string scenario = examples + "lag_unicycle/scenario.yaml";
  const std::vector<std::string> quick = {"--set", "limit.steps=3", "--set",
                                          "controller.horizon=3"};
  const auto expect_done = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    const ProcessResult result = run_qsmpc(arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments[0] << ": " << result.errors;
    return result;
  };
  EXPECT_EQ(run_qsmpc({"validate", scenario}).exit_code, 0);
  expect_done({"predict", scenario, "--monte-carlo", "1000", "--out", folder.path() + "/p"});
  expect_done({"compare", scenario, "--plant", "analytic", "--episodes", "2", "--out",
               folder.path() + "/c"});
  expect_done({"run", scenario, "--no-video", "--out", folder.path() + "/r"});
  const std::string grid = folder.path() + "/grid.yaml";
  std::ofstream(grid)
      << "name: grid\nscenario: " << scenario
      << "\ngrid: {model.parameters.speed_lag: [0.2, 0.5], controller.horizon: [3], "
         "limit.steps: [3]}\nseeds: {count: 2}\ntraces: none\n";
  const ProcessResult campaign =
      run_qsmpc({"campaign", grid, "--jobs", "2", "--out", folder.path() + "/g"});
  EXPECT_EQ(campaign.exit_code, 0) << campaign.errors;
}

/// The first block of `language` in the page about own dynamics.
std::string documented(const std::string& language) {
  const std::string page = read_text(std::string(QSMPC_SOURCE_DIR) + "/docs/dynamics.md");
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = page.find(fence) + fence.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

TEST(OwnDynamicsCommands, take_what_the_page_about_them_shows) {
  const TemporaryFolder folder;
  const std::string boat = folder.path() + "/my_boat.yaml";
  std::ofstream(boat) << documented("yaml");
  const ProcessResult drive = run_qsmpc({"run", boat, "--no-video", "--out", folder.path() + "/b"});
  EXPECT_EQ(drive.exit_code, 0) << drive.errors;
  EXPECT_THAT(drive.output + drive.errors, HasSubstr("reached"));

  std::ofstream(folder.path() + "/cart.cpp") << documented("cpp");
  const std::string command = "c++ -std=c++20 -O1 -Wall -Wextra -Werror -shared -fPIC -I '" +
                              std::string(QSMPC_PUBLIC_HEADERS) + "' '" + folder.path() +
                              "/cart.cpp' -o '" + folder.path() + "/my_cart.so'";
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT: fixed
  std::ofstream(folder.path() + "/cart.yaml")
      << "name: cart\nmodel: {library: my_cart.so, parameters: {mass: 3}}\n"
         "plant: {kind: analytic}\ninitial_state: {mean: [0, 0]}\ntarget: {state: [1, 0]}\n";
  const ProcessResult valid = run_qsmpc({"validate", folder.path() + "/cart.yaml"});
  EXPECT_EQ(valid.exit_code, 0) << valid.errors << valid.output;
}

TEST(OwnDynamicsCommands, say_the_place_of_what_is_wrong_with_a_formula) {
  const std::string scenario = examples + "lag_unicycle/scenario.yaml";
  const ProcessResult result =
      run_qsmpc({"run", scenario, "--set", "model.equations.x=x + time_step * sped"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors + result.output,
              HasSubstr("model.equations.x: found the name 'sped' in column 17, expected speed"));
}

}  // namespace own_dynamics_test
}  // namespace qsmpc::harness
