// `qsmpc predict` from the outside: exit codes, output, files left behind.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/trace/hdf5_file.hpp"
#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace predict_test {

using namespace testing;

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// Few particles, to keep tests quick.
const std::vector<std::string> kSmall = {
    "--set", "controller.quantisation={state: 27, noise: 16, compressed: 27}"};

ProcessResult predict(const std::string& scenario, const std::string& out,
                      const std::vector<std::string>& more, const ProcessOptions& options = {}) {
  std::vector<std::string> arguments = {"predict", scenario, "--out", out};
  arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_qsmpc(arguments, options);
}

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

class PredictScenario : public ::testing::TestWithParam<const char*> {};

TEST_P(PredictScenario, certificates_are_probabilities_that_the_simulation_does_not_exceed) {
  const TemporaryFolder folder;
  const ProcessResult result = predict(
      GetParam(), folder.path(), {"--steps", "5", "--monte-carlo", "20000", "--json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(result.output, read_text(folder.path() + "/predict.json"));
  const auto json = nlohmann::json::parse(result.output);
  ASSERT_EQ(json["stages"].size(), 5U);
  EXPECT_EQ(json["inputs"].size(), 5U);
  for (const auto& stage : json["stages"]) {
    const auto& certificate = stage["certificate"];
    for (const auto& bound : certificate["all"]) {
      EXPECT_GE(bound, certificate["value"]);
      EXPECT_LE(bound, 1.0);
      EXPECT_GE(bound, stage["monte_carlo"]["lower"]);
    }
    EXPECT_GE(certificate["value"], 0.0);
    EXPECT_LE(stage["monte_carlo"]["lower"], stage["monte_carlo"]["rate"]);
    EXPECT_GE(stage["monte_carlo"]["upper"], stage["monte_carlo"]["rate"]);
  }
  EXPECT_GE(json["horizon"]["value"], json["horizon"]["monte_carlo"]["lower"]);
  EXPECT_THAT(files_in(folder.path()), SizeIs(3));
  EXPECT_EQ(Hdf5File::open(folder.path() + "/predict.h5").text("/", "kind"), "prediction");
  EXPECT_THAT(read_text(folder.path() + "/scenario.yaml"), HasSubstr("horizon: 5"));
}

INSTANTIATE_TEST_SUITE_P(Shipped, PredictScenario,
                         ::testing::Values("dubins_obstacles", "dubins_corridor",
                                           "double_integrator", "bicycle_obstacles"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(Predict, compares_all_methods_with_the_simulated_paths) {
  const TemporaryFolder folder;
  const std::vector<std::string> more = {"--steps", "3",   "--methods",     "all",
                                         "--at",    "1,3", "--monte-carlo", "20000"};
  const ProcessResult result = predict("dubins_corridor", folder.path(), more);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("Stage 1, against 20000 paths; P(unsafe) from "));
  EXPECT_THAT(result.output, HasSubstr("Stage 3, "));
  const auto json = nlohmann::json::parse(read_text(folder.path() + "/predict.json"));
  const auto listed = nlohmann::json::parse(run_qsmpc({"list", "methods", "--json"}).output);
  EXPECT_EQ(json["methods"].size(), listed["methods"].size());
  for (const auto& method : listed["methods"]) {
    const auto& errors = json["methods"].at(method["name"].get<std::string>());
    ASSERT_EQ(errors["stages"].size(), 3U) << method["name"];
    EXPECT_GT(errors["ms"], 0.0) << method["name"];
    for (const auto& stage : errors["stages"]) {
      EXPECT_GT(stage["w2"], 0.0) << method["name"];
      EXPECT_GE(stage["unsafe"], 0.0) << method["name"];
    }
  }
}

TEST(Predict, refuses_unknown_methods_and_stages_that_are_not_predicted) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::vector<std::string>& more) {
    const ProcessResult result = predict("dubins_corridor", folder.path(), more);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    return result.errors;
  };
  EXPECT_THAT(refused({"--methods", "telepathy"}), HasSubstr("telepathy"));
  EXPECT_THAT(refused({"--at", "1"}), HasSubstr("--methods"));
  EXPECT_THAT(refused({"--methods", "unscented", "--steps", "3", "--at", "4"}),
              HasSubstr("--at: found 4, expected stages from 1 to 3"));
  EXPECT_THAT(refused({"--methods", "unscented", "--monte-carlo", "1999"}),
              HasSubstr("at least 2000 paths"));
  EXPECT_TRUE(files_in(folder.path()).empty());
}

TEST(Predict, prints_a_table_and_uses_the_named_folder_by_default) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_qsmpc({"predict", "dubins_corridor", "--steps", "2"}, {.folder = folder.path()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("dubins_corridor: 2 stages"));
  EXPECT_THAT(result.output, HasSubstr("out/dubins_corridor-predict/predict.json"));
  EXPECT_TRUE(fs::exists(folder.path() + "/out/dubins_corridor-predict/predict.h5"));
}

TEST(Predict, what_differs_has_a_folder_of_its_own_by_default) {
  const TemporaryFolder folder;
  const auto run_with = [&](const std::string& setting) {
    return run_qsmpc({"predict", "dubins_corridor", "--quiet", "--steps", "1", "--set", setting},
                     {.folder = folder.path()})
        .exit_code;
  };
  const std::string out = folder.path() + "/out";
  ASSERT_EQ(run_with("controller.horizon=2"), 0);
  ASSERT_EQ(run_with("controller.horizon=3"), 0);
  EXPECT_THAT(files_in(out), SizeIs(2));
  // The same command may reuse its folder.
  ASSERT_EQ(run_with("controller.horizon=3"), 0);
  EXPECT_THAT(files_in(out), SizeIs(2));
  ASSERT_EQ(run_with("name=a/b"), 0);
  ASSERT_EQ(run_with("name=a_b"), 0);
  EXPECT_THAT(files_in(out), SizeIs(4));
}

TEST(Predict, one_seed_gives_the_same_bytes_and_another_one_others) {
  const TemporaryFolder folder;
  const auto numbers = [&](const char* name, const char* seed) {
    const std::string out = folder.path() + "/" + name;
    EXPECT_EQ(predict("dubins_corridor", out,
                      {"--monte-carlo", "20000", "--seed", seed, "--quiet", "--set",
                       "safe_set.bounds={x: [-0.4, 12], y: [-1, 12]}"})
                  .exit_code,
              0);
    return read_text(out + "/predict.json");
  };
  const std::string first = numbers("first", "3");
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(numbers("second", "3"), first);
  EXPECT_NE(numbers("third", "4"), first);
}

TEST(Predict, takes_the_inputs_of_a_file) {
  const TemporaryFolder folder;
  const std::string csv = folder.file("inputs.csv", "yaw_rate\n0.3\n-0.1\n0.25\n");
  const ProcessResult all =
      predict("dubins_corridor", folder.path() + "/a", {"--inputs", csv, "--json"});
  ASSERT_EQ(all.exit_code, 0) << all.errors;
  EXPECT_EQ(nlohmann::json::parse(all.output)["inputs"],
            nlohmann::json::parse("[[0.3],[-0.1],[0.25]]"));
  const ProcessResult two =
      predict("dubins_corridor", folder.path() + "/b", {"--inputs", csv, "--steps", "2", "--json"});
  EXPECT_EQ(nlohmann::json::parse(two.output)["stages"].size(), 2U);
}

TEST(Predict, refuses_bad_input_in_one_line_and_writes_nothing) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  const std::string outside = folder.file("outside.csv", "0.1\n77\n");
  const std::string word = folder.file("word.csv", "0.1\nleft\n");
  const std::string good = folder.file("good.csv", "0.1\n0.2\n");
  const std::vector<std::pair<std::vector<std::string>, const char*>> cases = {
      {{"--inputs", outside}, "outside.csv:2: column 1 (yaw_rate): found 77, expected a number"},
      {{"--inputs", word}, "word.csv:2: column 1 (yaw_rate): found left, expected a finite number"},
      {{"--inputs", good, "--steps", "3"}, "good.csv: found 2 rows, expected at least 3"},
      {{"--inputs", folder.path() + "/missing.csv"}, "missing.csv: found No such file"},
      {{"--inputs", folder.path()}, "found a folder"},
      {{"--steps", "0"}, "--steps"},
      {{"--steps", "1001"}, "--steps"},
      {{"--monte-carlo", "0"}, "--monte-carlo"},
      {{"--set", "controller.horizon=0"}, "controller.horizon"},
  };
  for (const auto& [arguments, message] : cases) {
    const ProcessResult result = predict("dubins_corridor", out, arguments);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(lines(result.errors), 1) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(message));
  }
  const ProcessResult unknown = predict("dubins_corridr", out, {});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("dubins_corridor"));
  EXPECT_FALSE(fs::exists(out));
}

TEST(Predict, a_folder_that_cannot_be_written_is_exit_code_3) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a_file", "");
  const ProcessResult result = predict("dubins_corridor", file + "/below", {});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(lines(result.errors), 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(file));
}

TEST(Predict, a_full_disk_is_exit_code_3_and_keeps_the_older_files) {
  const TemporaryFolder folder;
  ASSERT_EQ(predict("dubins_corridor", folder.path(), {"--steps", "2"}).exit_code, 0);
  const std::string before = read_text(folder.path() + "/predict.json");
  for (const long limit : {500L, 20'000L}) {
    const ProcessResult result = predict("dubins_corridor", folder.path(),
                                         {"--steps", "6", "--force"}, {.file_size_limit = limit});
    EXPECT_EQ(result.exit_code, 3) << result.errors;
    EXPECT_THAT(files_in(folder.path()), SizeIs(3)) << "nothing unfinished is left";
    EXPECT_EQ(read_text(folder.path() + "/predict.json"), before);
  }
}

/// Sends `signal` once the output folder exists: the long simulation is about to start then.
ProcessResult predict_and_signal(const std::string& out, int signal) {
  return predict("dubins_corridor", out, {"--monte-carlo", "1000000000", "--quiet"},
                 {.meanwhile = [&](pid_t process) {
                   if (!fs::exists(out)) return false;
                   kill(process, signal);
                   return true;
                 }});
}

TEST(Predict, an_interrupt_keeps_the_prediction_without_the_simulation) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  const ProcessResult result = predict_and_signal(out, SIGINT);
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("interrupted"));
  const auto json = nlohmann::json::parse(read_text(out + "/predict.json"));
  EXPECT_FALSE(json["stages"][0].contains("monte_carlo"));
  EXPECT_THAT(files_in(out), SizeIs(3));
}

TEST(Predict, a_kill_during_the_simulation_leaves_nothing) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  EXPECT_EQ(predict_and_signal(out, SIGKILL).exit_code, 128 + SIGKILL);
  EXPECT_THAT(files_in(out), SizeIs(0));
}

}  // namespace predict_test
}  // namespace qsmpc::harness
