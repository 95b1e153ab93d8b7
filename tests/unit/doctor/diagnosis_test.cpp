// How a plant's answers are diagnosed; those of the shipped plants are correct.
#include "harness/doctor/diagnosis.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/doctor/gain_search.hpp"
#include "harness/doctor/plant_answers.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/shipped_files.hpp"

namespace qsmpc::harness {
namespace diagnosis_test {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kRobot = "differential_robot";

/// The shipped robot with its holding gain (12.5 by design) and its turning gain (2.25).
Scenario robot(double hold, double turn, const std::vector<std::string>& more = {}) {
  const std::string held = ", parameter: speed, gain: " + std::to_string(hold) + "}";
  std::vector<std::string> overrides{
      "plant.hold=[{actuator: left_motor" + held + ", {actuator: right_motor" + held + "]",
      "plant.input.yaw_rate=[{actuator: left_motor, gain: " + std::to_string(-turn) +
          "}, {actuator: right_motor, gain: " + std::to_string(turn) + "}]"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario(kRobot, overrides);
}

TEST(Diagnosis, a_hold_ten_times_too_slow_is_reported_with_numbers) {
  EXPECT_THAT(
      plant_warnings(robot(1.25, 2.25)),
      Contains(AllOf(HasSubstr("without an input, x changes by 0.064 m in 0.8 s"),
                     HasSubstr("0.64 m in the model"), HasSubstr("0.0999 times the model's"))));
}

TEST(Diagnosis, a_vehicle_that_tips_over_while_settling_is_reported) {
  EXPECT_THAT(
      plant_warnings(load_scenario(kRobot, {"model.speed=3"})),
      Contains(HasSubstr(
          "the vehicle tips over while settling: at the start of a drive it is tilted by ")));
}

TEST(Diagnosis, an_input_of_the_wrong_sign_is_reported_although_the_noise_is_large) {
  const std::string noise = "disturbance.covariance=[1, 1, 1]";
  EXPECT_THAT(plant_warnings(robot(12.5, -2.25, {noise})),
              Contains(AllOf(HasSubstr("yaw_rate held at ±0.2 rad/s changes heading by −0.16"),
                             HasSubstr("the wrong sign"))));
}

// 0.055 m per period short of the model's 0.3 m: of nearly the right size, with noise of 0.01 m.
TEST(Diagnosis, a_mismatch_of_several_deviations_of_the_noise_is_reported) {
  const std::vector<std::string> cases{"disturbance.covariance=[0.0001, 0.0001]",
                                       "disturbance.covariance=[0.0025, 0.0025]"};
  std::vector<std::size_t> warnings;
  for (const std::string& noise : cases) {
    Scenario scenario = load_scenario("double_integrator", {"plant.kind=mujoco", noise});
    PlantAnswers answers{.periods = 8,
                         .period = 0.1,
                         .start = Eigen::Vector2d::Zero(),
                         .scale = Eigen::Vector2d(2.4, 1.0),
                         .inputs = {}};
    const Eigen::VectorXd periods = Eigen::VectorXd::LinSpaced(8, 1.0, 8.0);
    const StateAnswer position{.model = 0.3 * periods,
                               .plant = 0.245 * periods,
                               .ratio = 0.245 / 0.3,
                               .discrepancy = 0.055};
    const StateAnswer velocity{.model = Eigen::VectorXd::Zero(8),
                               .plant = Eigen::VectorXd::Zero(8),
                               .ratio = std::nan("")};
    answers.inputs.push_back({.states = {position, velocity}});
    const std::vector<std::string> told = answer_warnings(scenario, answers);
    warnings.push_back(told.size());
    if (!told.empty()) {
      EXPECT_THAT(told.front(), AllOf(HasSubstr("differ by up to 0.055 m per period"),
                                      HasSubstr("noise is 0.01 m")));
    }
  }
  EXPECT_THAT(warnings, ElementsAre(1U, 0U));
}

TEST(Diagnosis, an_input_that_acts_late_is_reported) {
  EXPECT_THAT(plant_warnings(robot(12.5, 2.25, {"plant.input_delay=0.3"})),
              Contains(HasSubstr("s late")));
}

TEST(Diagnosis, gains_are_found_that_make_the_plant_answer_as_the_model) {
  const Scenario wrong = robot(1.25, -22.5);
  const GainSearch search = search_gains(wrong, plant_answers(wrong));
  EXPECT_TRUE(search.changed);
  // The design value; wheels slip slightly.
  EXPECT_NEAR(search.mapping.holds.front().constant.gain, 12.5, 0.125);
  EXPECT_NEAR(search.mapping.inputs.at("yaw_rate").back().gain, 2.25, 0.0225);
  EXPECT_THAT(answer_warnings(wrong, search.answers), IsEmpty());
}

TEST(Diagnosis, every_shipped_plant_answers_as_its_model) {
  for (const std::string& name : shipped_scenario_names()) {
    const Scenario scenario = load_scenario(name, {"plant.kind=mujoco"});
    EXPECT_THAT(plant_warnings(scenario), IsEmpty()) << name;
  }
}

TEST(Diagnosis, the_model_itself_is_not_driven) {
  EXPECT_THAT(plant_warnings(load_scenario("dubins_corridor")), IsEmpty());
}

}  // namespace diagnosis_test
}  // namespace qsmpc::harness
