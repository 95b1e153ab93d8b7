// The example of a user's own vehicle, as on its page.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::testing {
namespace own_vehicle_test {

using ::testing::HasSubstr;

const std::string kScenario = std::string(QSMPC_SOURCE_DIR) + "/examples/own_vehicle/scenario.yaml";

TEST(OwnVehicle, answers_as_the_model_with_the_gain_that_the_doctor_suggests) {
  const ProcessResult shipped = run_qsmpc({"doctor", kScenario});
  EXPECT_EQ(shipped.exit_code, 0) << shipped.output << shipped.errors;

  const ProcessResult guessed =
      run_qsmpc({"doctor", kScenario, "--json", "--set",
                 "plant.input={yaw_rate: [{actuator: steering, gain: 1}]}"});
  EXPECT_EQ(guessed.exit_code, 1);
  const std::string suggestion =
      nlohmann::json::parse(guessed.output).at("suggestion").at("plant").get<std::string>();
  const std::string before = "actuator: \"steering\", gain: ";
  const std::size_t at = suggestion.find(before);
  ASSERT_NE(at, std::string::npos) << suggestion;
  // The wheelbase over the speed, to the accuracy of a measurement at a tenth of the input's range.
  EXPECT_NEAR(std::stod(suggestion.substr(at + before.size())), 0.6, 0.01);
}

TEST(OwnVehicle, does_not_hold_its_speed_without_the_loop) {
  const ProcessResult result = run_qsmpc({"doctor", kScenario, "--set", "plant.loops=[]", "--set",
                                          "plant.hold=[{actuator: motor, gain: 0}]"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("warning: without an input, x changes by"));
}

TEST(OwnVehicle, arrives_and_leaves_a_page_and_a_video) {
  const TemporaryFolder folder;
  const ProcessResult result = run_qsmpc({"run", kScenario, "--quiet", "--out", folder / "out",
                                          "--set", "video.size=320x180", "--set", "video.fps=5"});
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  const auto summary = nlohmann::json::parse(read_text(folder / "out/summary.json"));
  EXPECT_EQ(summary["outcome"], "reached");
  EXPECT_GT(summary["min_clearance"], 0.02);
  EXPECT_GT(std::filesystem::file_size(folder / "out/episode.mp4"), 10'000U);
  EXPECT_THAT(read_text(folder / "out/report.html"), HasSubstr("own_vehicle"));
}

}  // namespace own_vehicle_test
}  // namespace qsmpc::testing
