// Faulty vehicles and mappings from the outside: what `validate` and `run` refuse, what `run` warns
// about, and what `doctor` prints.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace doctor_test {

using namespace testing;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kServo = R"(<mujoco>
<option timestep="0.001" gravity="0 0 0"/>
<worldbody><body><joint name="rail" type="slide" axis="1 0 0"/><geom size="0.1" mass="1"/></body></worldbody>
<actuator><velocity name="servo" joint="rail" kv="1000"/></actuator>
</mujoco>
)";

/// A double integrator on `mjcf`, which the scenario names in line 5.
std::string rail_scenario(const TemporaryFolder& folder, const std::string& mjcf,
                          const std::string& joint = "rail") {
  (void)folder.file("own.xml", mjcf);
  return folder.file("own.yaml",
                     "name: own\n"
                     "model: {system: double_integrator}\n"
                     "plant:\n"
                     "  kind: mujoco\n"
                     "  mjcf: own.xml\n"
                     "  state:\n"
                     "    position: {joint: " +
                         joint +
                         "}\n"
                         "    velocity: {joint: rail, quantity: velocity}\n"
                         "  input: {acceleration: [{actuator: servo}]}\n"
                         "initial_state: {mean: [0, 0]}\n"
                         "target: {state: [2, 0]}\n"
                         "controller: {horizon: 3}\n"
                         "limit: {steps: 2}\n");
}

struct WrongFile {
  const char* name;
  std::string mjcf;
  const char* joint;
  std::string place;  ///< after the scenario's path
  std::string words;
};

class WrongVehicle : public ::testing::TestWithParam<WrongFile> {};

TEST_P(WrongVehicle, is_refused_with_the_line_of_the_scenario_and_leaves_no_episode) {
  const WrongFile& wrong = GetParam();
  const TemporaryFolder folder;
  const std::string scenario = rail_scenario(folder, wrong.mjcf, wrong.joint);
  const std::string out = folder.path() + "/out";
  const ProcessResult run = run_qsmpc({"run", scenario, "--no-video", "--out", out});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors, AllOf(HasSubstr(scenario + wrong.place), HasSubstr(wrong.words)));
  EXPECT_FALSE(std::filesystem::exists(out));
  const ProcessResult validate = run_qsmpc({"validate", scenario, "--json"});
  EXPECT_EQ(validate.exit_code, 2);
  const auto errors = nlohmann::json::parse(validate.output).at("errors");
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_THAT(":" + std::to_string(errors[0].at("line").get<int>()) + ": " +
                  errors[0].at("key").get<std::string>() + ": ",
              StartsWith(wrong.place));
  EXPECT_THAT(
      errors[0].at("found").get<std::string>() + errors[0].at("expected").get<std::string>(),
      HasSubstr(wrong.words));
}

INSTANTIATE_TEST_SUITE_P(
    Files, WrongVehicle,
    ::testing::Values(WrongFile{"malformed", "<mujoco><worldbody></mujoco>", "rail",
                                ":5: plant.mjcf: ", "own.xml:1: found XML"},
                      WrongFile{"missing_include", "<mujoco><include file=\"no.xml\"/></mujoco>",
                                "rail", ":5: plant.mjcf: ", "no.xml"},
                      WrongFile{"newer", "<mujoco><option integrator=\"implicitfast\"/></mujoco>",
                                "rail", ":5: plant.mjcf: ", "write implicit"},
                      WrongFile{"missing_name", kServo, "sldie",
                                ":7: plant.state.position.joint: ", "one of rail"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(Doctor, a_vehicle_that_is_only_drawn_has_to_load) {
  const TemporaryFolder folder;
  (void)folder.file("own.xml", "<mujoco><oops/></mujoco>");
  const std::string scenario =
      folder.file("own.yaml",
                  "name: own\nmodel: {system: dubins}\nplant: {kind: analytic, mjcf: "
                  "own.xml}\nvehicle: {footprint: point}\n"
                  "initial_state: {mean: [0, 0, 0]}\ntarget: {state: [2, 0, 0]}\n");
  const ProcessResult result = run_qsmpc({"validate", scenario});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output + result.errors, HasSubstr(scenario + ":3: plant.mjcf: "));
}

TEST(Doctor, run_warns_of_a_time_step_at_which_the_plant_diverges) {
  const TemporaryFolder folder;
  const std::string scenario = rail_scenario(folder, kServo);
  const auto run = [&](const std::string& time_step) {
    return run_qsmpc({"run", scenario, "--no-video", "--set", "plant.time_step=" + time_step,
                      "--out", folder.path() + "/out" + time_step});
  };
  EXPECT_THAT(run("0.01").errors, HasSubstr("warning: the plant fails within 8 periods"));
  EXPECT_THAT(run("0.001").errors, Not(HasSubstr("the plant fails")));
}

/// A differential robot whose wheels turn too slowly for its speed.
constexpr const char* kSlowWheels =
    "[{actuator: left_motor, parameter: speed, gain: 1.25}, "
    "{actuator: right_motor, parameter: speed, gain: 1.25}]";

TEST(Doctor, compare_and_campaign_warn_with_the_name_of_the_plant_or_variant) {
  const TemporaryFolder folder;
  const ProcessResult compare =
      run_qsmpc({"compare", "differential_robot", "--set", std::string("plant.hold=") + kSlowWheels,
                 "--set", "limit.steps=2", "--plant", "analytic", "--plant", "mujoco", "--episodes",
                 "1", "--paths", "20", "--out", folder.path() + "/compare"});
  EXPECT_THAT(compare.errors, HasSubstr("qsmpc: warning: mujoco: "));
  EXPECT_THAT(compare.errors, Not(HasSubstr("warning: analytic")));
  const std::string campaign =
      folder.file("wheels.yaml",
                  std::string("name: wheels\nscenario: differential_robot\nvariants:\n"
                              "  fast: {}\n  slow: {plant.hold: ") +
                      kSlowWheels + "}\ngrid: {limit.steps: [2]}\nseeds: {first: 1, count: 1}\n");
  const ProcessResult drives =
      run_qsmpc({"campaign", campaign, "--out", folder.path() + "/drives"});
  EXPECT_THAT(drives.errors, HasSubstr("qsmpc: warning: slow"));
  EXPECT_THAT(drives.errors, Not(HasSubstr("warning: fast")));
}

TEST(Doctor, prints_every_answer_and_gains_that_work) {
  const std::string slow = std::string("plant.hold=") + kSlowWheels;
  const ProcessResult wrong = run_qsmpc({"doctor", "differential_robot", "--set", slow, "--json"});
  EXPECT_EQ(wrong.exit_code, 1) << wrong.errors;
  const auto json = nlohmann::json::parse(wrong.output);
  EXPECT_EQ(json.at("answers").size(), 6U);  // three states, each without and with the input
  EXPECT_EQ(json.at("answers")[0].at("verdict"), "size");
  const TemporaryFolder folder;
  const std::string mended =
      folder.file("mended.yaml",
                  "name: mended\nmodel: {system: dubins, speed: 0.8}\n"
                  "initial_state: {mean: [0, 0, 0]}\ntarget: {state: [2, 0, 0]}\n"
                  "plant:\n  kind: mujoco\n  mjcf: differential_robot.xml\n  state:\n"
                  "    x: {body: base, quantity: x}\n    y: {body: base, quantity: y}\n"
                  "    heading: {body: base, quantity: yaw}\n" +
                      json.at("suggestion").at("plant").get<std::string>());
  const ProcessResult right = run_qsmpc({"doctor", mended});
  EXPECT_EQ(right.exit_code, 0) << right.output << right.errors;
  EXPECT_THAT(right.output, HasSubstr("ok: sign, size and delay match the model"));
}

TEST(Doctor, an_analytic_plant_has_nothing_to_check) {
  const ProcessResult result = run_qsmpc({"doctor", "dubins_corridor"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("plant.kind"), HasSubstr("mujoco")));
  EXPECT_EQ(run_qsmpc({"doctor", "dubins_corridor", "--plant", "mujoco_planar"}).exit_code, 0);
}

}  // namespace doctor_test
}  // namespace qsmpc::harness
