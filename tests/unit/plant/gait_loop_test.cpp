// Vehicles with legs, walking by a gait of the mapping.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/doctor/diagnosis.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/unit/plant/plant_fixture.hpp"

namespace qsmpc::harness {
namespace gait_loop_test {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kPeriod = 0.5;  // s

const std::string kFolder = QSMPC_SOURCE_DIR "/examples/quadruped";

Scenario example(const std::vector<std::string>& overrides = {}) {
  return load_scenario(kFolder + "/scenario.yaml", overrides);
}

/// The example with these `actuators` of its gait.
Scenario with_gait(const std::string& actuators) {
  return example({"plant.loops=[{kind: gait, cycle: 0.5, actuators: [" + actuators + "]}]"});
}

/// How far the quadruped walks and turns in `periods` of this yaw rate.
Eigen::VectorXd walked(const Scenario& scenario, double turn, int periods) {
  const auto plant = make_plant(scenario);
  plant->reset(pose(0.0, 0.0, 0.0));
  Eigen::VectorXd state = pose(0.0, 0.0, 0.0);
  for (int k = 0; k < periods; ++k) {
    const PlantStep step = plant->advance(yaw_rate(turn), no_disturbance());
    EXPECT_FALSE(step.fault.has_value()) << *step.fault;
    state = step.state;
  }
  return state;
}

TEST(GaitLoop, walks_straight_at_the_speed_of_the_model) {
  const Eigen::VectorXd end = walked(example(), 0.0, 10);
  EXPECT_NEAR(end[0], 10 * kPeriod * 0.327, 0.1);
  EXPECT_LT(std::abs(end[1]), 0.15);
  EXPECT_LT(std::abs(end[2]), 0.1);
}

TEST(GaitLoop, turns_at_the_yaw_rate_to_either_side) {
  for (const double turn : {-0.5, -0.2, 0.2, 0.5}) {
    const double expected = 10 * kPeriod * turn;
    EXPECT_NEAR(walked(example(), turn, 10)[2], expected, 0.15 * std::abs(expected)) << turn;
  }
}

TEST(GaitLoop, answers_as_the_model_within_what_the_doctor_allows) {
  EXPECT_THAT(plant_warnings(example()), IsEmpty());
}

TEST(GaitLoop, the_same_steps_after_reset_are_equal_bit_for_bit) {
  const auto plant = make_plant(example());
  std::vector<Eigen::VectorXd> ends;
  for (int repetition = 0; repetition < 2; ++repetition) {
    plant->reset(pose(1.0, 2.0, 0.5));
    for (int k = 0; k < 4; ++k) {
      ends.push_back(plant->advance(yaw_rate(0.4), pose(0.01, -0.02, 0.005)).state);
    }
  }
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(ends[k], ends[k + 4]);
}

TEST(GaitLoop, swings_in_opposite_phases_cancel) {
  const std::string hip = "{actuator: front_left_hip, amplitude: 0.3";
  const std::string turning = "{actuator: rear_left_hip, input: yaw_rate, gain: 0.5";
  const Scenario scenario = with_gait(hip + "}, " + hip + ", phase: 0.5}, " + turning +
                                      ", phase: 0.25}, " + turning + ", phase: 0.75}");
  const Eigen::VectorXd end = walked(scenario, 0.5, 5);
  EXPECT_LT(end.cwiseAbs().maxCoeff(), 2e-3) << "it stands";
  EXPECT_GT(walked(with_gait(hip + "}, " + turning + "}"), 0.5, 5).cwiseAbs().maxCoeff(), 5e-3)
      << "without the opposite ones it would not";
}

TEST(GaitLoop, a_resolved_scenario_has_it) {
  const std::string text = to_yaml(example());
  EXPECT_THAT(text, HasSubstr("kind: gait"));
  const Scenario again = parse_scenario(text, {.file = "again.yaml", .folder = ""});
  EXPECT_EQ(to_yaml(again), text);
}

InputError::Where refusal(const std::vector<std::string>& overrides) {
  try {
    (void)make_plant(example(overrides));
  } catch (const InputError& error) {
    return error.where();
  }
  ADD_FAILURE() << "not refused";
  return {};
}

InputError::Where refused_gait(const std::string& actuators) {
  return refusal({"plant.input={yaw_rate: [{actuator: front_left_hip}]}",
                  "plant.loops=[{kind: gait, cycle: 0.5, actuators: [" + actuators + "]}]"});
}

TEST(GaitLoop, refuses_what_it_cannot_do) {
  EXPECT_THAT(refusal({"plant.settling=1.9"}).expected, HasSubstr("whole number of cycles"));
  EXPECT_EQ(refusal({"plant.settling=1.9"}).key, "plant.settling");
  EXPECT_THAT(refused_gait("{actuator: front_left_hip}").expected, HasSubstr("input"));
  EXPECT_THAT(refused_gait("").expected, HasSubstr("at least one actuator"));
  EXPECT_THAT(refused_gait("{actuator: no_such_hip, amplitude: 1}").key, HasSubstr("no_such_hip"));
  EXPECT_EQ(refused_gait("{actuator: front_left_hip, amplitude: 1, input: yaw_rate, gain: 0}").key,
            "plant.loops.0.actuators.0.gain");
  EXPECT_THAT(refused_gait("{actuator: front_left_hip, amplitude: 1, input: speed}").expected,
              HasSubstr("yaw_rate"));
  EXPECT_EQ(refused_gait("{actuator: front_left_hip, amplitude: 1, gain: 2}").expected,
            "an `input` beside it");
  EXPECT_THAT(refusal({"plant.loops=[{kind: gait, cycle: 0.01, actuators: [{actuator: "
                       "front_left_hip, input: yaw_rate}]}]"})
                  .expected,
              HasSubstr("at least ten steps, 0.025 s"));
  EXPECT_EQ(refusal({"plant.loops=[{kind: gait, actuators: [{actuator: front_left_hip, input: "
                     "yaw_rate}]}]"})
                .key,
            "plant.loops.0.cycle");
}

}  // namespace gait_loop_test
}  // namespace qsmpc::harness
