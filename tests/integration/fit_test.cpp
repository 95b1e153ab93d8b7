// `qsmpc fit`: constants of the model from drives of a vehicle in MuJoCo.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace fit_test {

using namespace testing;

using ::testing::HasSubstr;

/// Drives the car on wheels for some periods with a model whose steering does not lag.
void drive_without_lag(const std::string& out) {
  const ProcessResult drive =
      run_qsmpc({"run", "certified_car", "--set", "model_error={rms: [0, 0, 0, 0]}", "--set",
                 "model.parameters.lag=0", "--set", "model.parameters.slew=0", "--set",
                 "limit.steps=40", "--no-video", "--quiet", "--fail-on", "none", "--out", out});
  ASSERT_EQ(drive.exit_code, 0) << drive.errors;
}

TEST(Fit, finds_how_the_steering_of_the_car_lags) {
  const TemporaryFolder folder;
  drive_without_lag(folder / "drive");
  const ProcessResult table =
      run_qsmpc({"fit", folder / "drive", "--parameter", "lag", "--parameter", "slew"});
  ASSERT_EQ(table.exit_code, 0) << table.errors;
  EXPECT_THAT(table.output, HasSubstr("--set model.parameters.lag=0.0"));
  const ProcessResult numbers =
      run_qsmpc({"fit", folder / "drive", "--parameter", "lag", "--parameter", "slew", "--json"});
  const nlohmann::json fit = nlohmann::json::parse(numbers.output);
  EXPECT_EQ(fit["periods"], 40);
  EXPECT_EQ(fit["parameters"][0]["key"], "model.parameters.lag");
  // Those of the scenario, from other drives, are 0.0087 s and 0.0067 s²/rad.
  EXPECT_NEAR(fit["parameters"][0]["fitted"].get<double>(), 0.0087, 0.002);
  EXPECT_NEAR(fit["parameters"][1]["fitted"].get<double>(), 0.0067, 0.002);
  EXPECT_LT(fit["rms"]["after"][2].get<double>(), 0.1 * fit["rms"]["before"][2].get<double>());
}

TEST(Fit, refuses_unknown_constants_and_drives_with_other_states) {
  const TemporaryFolder folder;
  drive_without_lag(folder / "drive");
  const ProcessResult unknown = run_qsmpc({"fit", folder / "drive", "--parameter", "lagg"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("--parameter: found lagg, expected lag (known: "));
  const ProcessResult other =
      run_qsmpc({"run", "double_integrator", "--set", "limit.steps=2", "--no-video", "--quiet",
                 "--fail-on", "none", "--out", folder / "other"});
  ASSERT_EQ(other.exit_code, 0) << other.errors;
  const ProcessResult mixed =
      run_qsmpc({"fit", folder / "drive", folder / "other", "--parameter", "lag"});
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_THAT(mixed.errors,
              HasSubstr("found states position velocity, inputs acceleration, a period of 0.1 s"));
  EXPECT_EQ(run_qsmpc({"fit", folder / "none", "--parameter", "lag"}).exit_code, 2);
  const ProcessResult twice =
      run_qsmpc({"fit", folder / "drive", folder / "drive/", "--parameter", "lag"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.errors,
              HasSubstr("found the same drive a second time, expected each drive once"));
}

}  // namespace fit_test
}  // namespace qsmpc::harness
