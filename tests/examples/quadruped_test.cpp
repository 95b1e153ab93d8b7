// The example of a vehicle with legs, as on its page.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::testing {
namespace quadruped_test {

using ::testing::HasSubstr;

const std::string kScenario = std::string(QSMPC_SOURCE_DIR) + "/examples/quadruped/scenario.yaml";

TEST(Quadruped, answers_as_the_model_and_the_doctor_finds_a_wrong_speed) {
  const ProcessResult shipped = run_qsmpc({"doctor", kScenario});
  EXPECT_EQ(shipped.exit_code, 0) << shipped.output << shipped.errors;
  const ProcessResult guessed = run_qsmpc({"doctor", kScenario, "--set", "model.speed=0.7"});
  EXPECT_EQ(guessed.exit_code, 1) << guessed.output;
  EXPECT_THAT(guessed.output, HasSubstr("x        2.8 m     1.3 m"));
}

TEST(Quadruped, arrives_and_leaves_a_page_and_a_video) {
  const TemporaryFolder folder;
  for (const char* seed : {"0", "1", "2"}) {
    const ProcessResult result =
        run_qsmpc({"run", kScenario, "--quiet", "--seed", seed, "--out", folder / seed, "--set",
                   "video.size=320x180", "--set", "video.fps=5"});
    EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
    const auto summary = nlohmann::json::parse(read_text(folder / seed + "/summary.json"));
    EXPECT_EQ(summary["outcome"], "reached") << seed;
    EXPECT_GT(std::filesystem::file_size(folder / seed + "/episode.mp4"), 10'000U);
  }
}

}  // namespace quadruped_test
}  // namespace qsmpc::testing
