// `qsmpc compare` from the outside: exit codes, output, files left behind.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/trace/hdf5_file.hpp"
#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace compare_test {

using namespace testing;

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Few particles, periods, episodes and paths, to keep tests quick.
const std::vector<std::string> kSmall = {
    "--set", "controller.quantisation={state: 27, noise: 16, compressed: 27}", "--set",
    "limit.steps=15"};

void add_unless_given(std::vector<std::string>& arguments, const std::string& option,
                      const std::string& value) {
  if (std::ranges::find(arguments, option) != arguments.end()) return;
  arguments.push_back(option);
  arguments.push_back(value);
}

ProcessResult compare(const std::string& scenario, const std::string& out,
                      const std::vector<std::string>& more, const ProcessOptions& options = {}) {
  std::vector<std::string> arguments = {"compare", scenario};
  if (!out.empty()) arguments.insert(arguments.end(), {"--out", out});
  arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  add_unless_given(arguments, "--episodes", "2");
  add_unless_given(arguments, "--paths", "40");
  return run_qsmpc(arguments, options);
}

TEST(Compare, leaves_numbers_data_scenario_and_figures) {
  const TemporaryFolder folder;
  const ProcessResult result =
      compare("dubins_corridor", folder.path(),
              {"--plant", "analytic", "--plant", "mujoco_car", "--json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(result.output, read_text(folder.path() + "/comparison.json"));
  EXPECT_THAT(files_in(folder.path()),
              ElementsAre("certificates.svg", "comparison.h5", "comparison.json", "divergence.svg",
                          "report.html", "residuals.svg", "scenario.yaml", "w2.svg"));
  const auto json = nlohmann::json::parse(result.output);
  ASSERT_EQ(json["plants"].size(), 2U);
  const auto& model = json["plants"]["analytic"];
  const auto& car = json["plants"]["mujoco_car"];
  EXPECT_EQ(car["episodes"], 2);
  EXPECT_EQ(car["horizon"].size(), 8U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LE(model["one_step"]["rmse"][i], model["one_step"]["rounding"][i]);
    EXPECT_GT(car["one_step"]["rmse"][i], car["one_step"]["rounding"][i]);
  }
  EXPECT_EQ(model["closed_loop"]["certificate_exceeded"], 0);
  EXPECT_GE(car["closed_loop"]["unsafe_interval"][1], car["closed_loop"]["unsafe_rate"]);
  EXPECT_EQ(Hdf5File::open(folder.path() + "/comparison.h5").text("/", "kind"), "comparison");
  EXPECT_THAT(read_text(folder.path() + "/w2.svg"), HasSubstr("mujoco_car"));
}

TEST(Compare, report_makes_the_page_again_from_the_folder) {
  const TemporaryFolder folder;
  ASSERT_EQ(compare("dubins_corridor", folder.path(), {"--plant", "mujoco_car"}).exit_code, 0);
  const std::string page = folder.path() + "/report.html";
  const std::string before = read_text(page);
  EXPECT_THAT(before, HasSubstr("Under the plan the paths of mujoco_car diverge"));
  fs::remove(page);
  const ProcessResult result = run_qsmpc({"report", folder.path()});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output, page + "\n");
  EXPECT_TRUE(read_text(page) == before);
  const ProcessResult figures = run_qsmpc({"report", folder.path(), "--figures", "--titles"});
  EXPECT_EQ(figures.exit_code, 0) << figures.errors;
  EXPECT_THAT(files_in(folder.path() + "/figures"),
              ElementsAre("captions.txt", "certificates.pdf", "certificates.svg", "divergence.pdf",
                          "divergence.svg", "residuals.pdf", "residuals.svg", "w2.pdf", "w2.svg"));
  EXPECT_EQ(read_text(folder.path() + "/figures/w2.svg"), read_text(folder.path() + "/w2.svg"));
  const ProcessResult narrow = run_qsmpc({"report", folder.path(), "--figures", "--columns", "1"});
  EXPECT_EQ(narrow.exit_code, 0) << narrow.errors;
  EXPECT_THAT(read_text(folder.path() + "/figures/w2.svg"), HasSubstr("width=\"336\""));
  EXPECT_EQ(run_qsmpc({"report", folder.path(), "--columns", "1"}).exit_code, 2);
  fs::resize_file(folder.path() + "/comparison.h5", 5000);
  const ProcessResult damaged = run_qsmpc({"report", folder.path()});
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_THAT(damaged.errors, HasSubstr("comparison.h5"));
}

TEST(Compare, prints_a_table_and_uses_the_named_folder_by_default) {
  const TemporaryFolder folder;
  const ProcessResult result = compare("dubins_corridor", "", {}, {.folder = folder.path()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("analytic: matches the model except for rounding"));
  // With digits that depend on the settings.
  EXPECT_THAT(result.output,
              ContainsRegex("out/dubins_corridor-compare-[0-9a-f]+/comparison.json"));
  EXPECT_THAT(result.errors, HasSubstr("comparing: "));
}

TEST(Compare, the_scenarios_own_vehicle_is_compared_by_default) {
  const TemporaryFolder folder;
  const ProcessResult result = compare("dubins_obstacles", folder.path(), {"--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["plants"].size(), 2U);
  EXPECT_TRUE(json["plants"].contains("analytic"));
  EXPECT_TRUE(json["plants"].contains("mujoco"));
}

TEST(Compare, threads_and_a_second_run_change_nothing_but_the_speed) {
  const TemporaryFolder folder;
  const auto numbers = [&](const char* name, const char* threads) {
    const ProcessResult result =
        compare("dubins_corridor", folder.path() + "/" + name,
                {"--plant", "analytic", "--plant", "mujoco_car", "--threads", threads, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    auto json = nlohmann::json::parse(result.output);
    for (auto& plant : json["plants"]) plant.erase("speed");
    return json.dump();
  };
  EXPECT_EQ(numbers("one", "1"), numbers("three", "3"));
}

TEST(Compare, writes_a_model_error_that_makes_the_certificates_hold_for_the_plant) {
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/errors/car.yaml";
  const ProcessResult measured =
      compare("dubins_corridor", folder.path() + "/first",
              {"--plant", "mujoco_car", "--plant", "analytic", "--write-model-error", file,
               "--model-error-plant", "mujoco_car", "--json"});
  ASSERT_EQ(measured.exit_code, 0) << measured.errors;
  const auto error = nlohmann::json::parse(measured.output)["model_error"];
  EXPECT_EQ(error["plant"], "mujoco_car");
  EXPECT_THAT(read_text(file), HasSubstr("system: dubins"));
  const ProcessResult covered = compare("dubins_corridor", folder.path() + "/second",
                                        {"--set", "model_error=" + file, "--json"});
  ASSERT_EQ(covered.exit_code, 0) << covered.errors;
  const auto stages =
      nlohmann::json::parse(covered.output)["plants"]["analytic"]["certificate"]["stages"];
  for (const auto& stage : stages) EXPECT_GT(stage["with"], stage["without"]);
}

TEST(Compare, by_default_the_model_error_is_that_of_the_plant_named_last) {
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/own.yaml";
  const ProcessResult result =
      compare("dubins_obstacles", folder.path() + "/out", {"--write-model-error", file, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(nlohmann::json::parse(result.output)["model_error"]["plant"], "mujoco");
}

TEST(Compare, refuses_bad_input_in_one_line_and_writes_nothing) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  const std::string broken = folder.file("broken.xml", "<mujoco><worldbody></mujoco>");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--plant", "mujoco_cra"}, "mujoco_car"},
      {{"--plant", "submarine"}, "analytic, mujoco, "},
      {{"--plant", "analytic", "--plant", folder.path() + "/none.xml"}, "none.xml"},
      {{"--plant", broken}, "broken.xml"},
      {{"--model-error-plant", "analytic"}, "--write-model-error"},
      {{"--write-model-error", out + "/e.yaml", "--model-error-plant", "mujoco_car"}, "analytic"},
      {{"--episodes", "0"}, "--episodes"},
      {{"--paths", "0"}, "--paths"},
      {{"--threads", "0"}, "--threads"},
  };
  for (const auto& [arguments, message] : cases) {
    const ProcessResult result = compare("dubins_corridor", out, arguments);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(message));
  }
  EXPECT_FALSE(fs::exists(out));
}

TEST(Compare, a_full_disk_is_exit_code_3_and_leaves_nothing) {
  const TemporaryFolder folder;
  const ProcessResult result =
      compare("dubins_corridor", folder.path(), {}, {.file_size_limit = 3000});
  EXPECT_EQ(result.exit_code, 3) << result.errors;
  EXPECT_THAT(files_in(folder.path()), IsEmpty());
}

TEST(Compare, an_interrupt_leaves_nothing_under_a_final_name) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  const ProcessResult result = compare("dubins_corridor", out, {"--episodes", "100000", "--quiet"},
                                       {.meanwhile = [&](pid_t process) {
                                         if (!fs::exists(out)) return false;
                                         kill(process, SIGINT);
                                         return true;
                                       }});
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("interrupted"));
  EXPECT_THAT(files_in(out), IsEmpty());
}

}  // namespace compare_test
}  // namespace qsmpc::harness
