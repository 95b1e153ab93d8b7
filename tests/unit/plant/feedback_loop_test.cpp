// Vehicles driven by forces and torques, held at their speeds by feedback loops of the mapping.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/doctor/diagnosis.hpp"
#include "harness/doctor/gain_search.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/unit/plant/plant_fixture.hpp"

namespace qsmpc::harness {
namespace feedback_loop_test {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kGoal = 0.6;  // m/s

struct Vehicle {
  std::string mjcf;
  std::string heading;   ///< of the states
  std::string speed;     ///< quantity
  std::string push;      ///< actuator
  std::string yaw_rate;  ///< actuator
};

/// Drives along −y of its body, with torque-driven wheels.
const Vehicle kRobot{.mjcf = "torque_robot.xml",
                     .heading = "{body: base, quantity: yaw, offset: -1.5707963267948966}",
                     .speed = "{body: base, quantity: lateral_speed, gain: -1}",
                     .push = "both",
                     .yaw_rate = "turn"};
/// Pushed along its own x axis and twisted about z.
const Vehicle kPusher{.mjcf = "planar_pusher.xml",
                      .heading = "{joint: z}",
                      .speed = "{body: agent, quantity: forward_speed}",
                      .push = "push",
                      .yaw_rate = "twist"};

std::string body_of(const Vehicle& vehicle) {
  return vehicle.mjcf == kRobot.mjcf ? "base" : "agent";
}

/// The Dubins car at 0.6 m/s on `vehicle`; `more`: further keys of its speed loop.
Scenario scenario_of(const Vehicle& vehicle, const std::string& more = "",
                     const std::string& goal = "{parameter: speed}") {
  const std::string body = body_of(vehicle);
  return parse_scenario(
      "name: torque\nmodel: {system: dubins_rk4, speed: 0.6}\nplant:\n  kind: mujoco\n  mjcf: " +
          std::string(QSMPC_SOURCE_DIR "/tests/data/") + vehicle.mjcf +
          "\n  state: {x: {body: " + body + ", quantity: x}, y: {body: " + body +
          ", quantity: y}, heading: " + vehicle.heading + "}\n  settling: 2\n  loops:\n" +
          "    - {kind: feedback, quantity: " + vehicle.speed + ", goal: " + goal +
          ", actuators: [{actuator: " + vehicle.push + "}]" + more +
          "}\n    - {kind: feedback, quantity: {body: " + body +
          ", quantity: yaw_rate}, goal: {input: yaw_rate}, actuators: [{actuator: " +
          vehicle.yaw_rate +
          "}]}\n"
          "initial_state: {mean: [1, 2, 0.5]}\ntarget: {state: [9, 2, 0]}\n"
          "vehicle: {footprint: point}\n",
      {.file = "torque.yaml", .folder = ""});
}

TEST(FeedbackLoop, holds_the_speed_and_follows_a_yaw_rate_with_the_lag_of_its_time_constant) {
  const Scenario scenario = scenario_of(kRobot);
  const auto plant = make_plant(scenario);
  plant->reset(pose(1.0, 2.0, 0.5));
  const PlantStep straight = plant->advance(yaw_rate(0.0), no_disturbance());
  // Wheels slip slightly; the loop holds the measured speed.
  const Eigen::Vector3d expected(1.0 + kGoal * 0.1 * std::cos(0.5),
                                 2.0 + kGoal * 0.1 * std::sin(0.5), 0.5);
  EXPECT_LT((straight.state - expected).cwiseAbs().maxCoeff(), 2e-3);
  constexpr double kTurn = 0.5;  // rad/s
  Eigen::VectorXd state = straight.state;
  double turned = 0.0;
  for (int k = 0; k < 10; ++k) {
    const PlantStep step = plant->advance(yaw_rate(kTurn), no_disturbance());
    ASSERT_FALSE(step.fault.has_value()) << *step.fault;
    turned = step.state[2] - state[2];
    if (k == 0) {  // after a lag of 0.1 s, 1/e of one period's turn
      EXPECT_LT(turned, 0.7 * kTurn * 0.1);
    }
    EXPECT_LT(turned, 1.05 * kTurn * 0.1);
    state = step.state;
  }
  EXPECT_NEAR(turned, kTurn * 0.1, 0.02 * kTurn * 0.1);
}

TEST(FeedbackLoop, the_same_steps_after_reset_are_equal_bit_for_bit) {
  const auto plant = make_plant(scenario_of(kRobot));
  std::vector<Eigen::VectorXd> ends;
  for (int repetition = 0; repetition < 2; ++repetition) {
    plant->reset(pose(1.0, 2.0, 0.5));
    for (int k = 0; k < 5; ++k) {
      ends.push_back(plant->advance(yaw_rate(0.4), pose(0.01, -0.02, 0.005)).state);
    }
  }
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(ends[k], ends[k + 5]);
}

TEST(FeedbackLoop, answers_as_the_model_without_a_gain_being_given) {
  const Scenario scenario = scenario_of(kRobot);
  EXPECT_THAT(plant_warnings(scenario), IsEmpty());
}

TEST(FeedbackLoop, the_doctor_measures_a_response_that_was_given_wrong) {
  // At least fifty times the true value: the loop is too weak to follow.
  Scenario scenario = scenario_of(kRobot);
  std::get<FeedbackLoop>(scenario.plant.mapping->loops[1]).response = 2000.0;
  const PlantAnswers answers = plant_answers(scenario);
  EXPECT_THAT(answer_warnings(scenario, answers), Not(IsEmpty()));
  const GainSearch search = search_gains(scenario, answers);
  EXPECT_TRUE(search.changed);
  EXPECT_THAT(answer_warnings(scenario, search.answers), IsEmpty());
}

// Its heading turns at once while it keeps moving in the old direction: no loop of the forward
// speed can fix that, and the doctor has to report it.
TEST(FeedbackLoop, a_body_that_slides_sideways_is_warned_of) {
  EXPECT_THAT(plant_warnings(scenario_of(kPusher)), Contains(HasSubstr("changes x by")));
}

TEST(FeedbackLoop, a_resolved_scenario_has_it) {
  const std::string text = to_yaml(scenario_of(kPusher, ", response: 4.5"));
  EXPECT_THAT(text, HasSubstr("kind: feedback"));
  EXPECT_THAT(text, HasSubstr("response: 4.5"));
  const Scenario again = parse_scenario(text, {.file = "again.yaml", .folder = ""});
  EXPECT_EQ(to_yaml(again), text);
}

InputError::Where refusal(const std::string& more, const std::string& goal = "{gain: 0.6}",
                          const Vehicle& vehicle = kPusher) {
  try {
    (void)make_plant(scenario_of(vehicle, more, goal));
  } catch (const InputError& error) {
    return error.where();
  }
  ADD_FAILURE() << "not refused";
  return {};
}

TEST(FeedbackLoop, refuses_what_it_cannot_hold) {
  Vehicle position = kPusher;
  position.speed = "{body: agent, quantity: x}";
  EXPECT_THAT(refusal("", "{gain: 1}", position).expected, HasSubstr("forward_speed"));
  EXPECT_THAT(refusal("", "{}").expected, HasSubstr("parameter"));
  EXPECT_EQ(refusal(", time_constant: 0").key, "plant.loops.0.time_constant");
  EXPECT_EQ(refusal(", response: 0").key, "plant.loops.0.response");
  // More than the propeller can achieve against friction.
  EXPECT_THAT(refusal("", "{gain: 600}").expected, HasSubstr("a longer `settling`"));
  Vehicle sideways = kPusher;
  sideways.speed = "{body: agent, quantity: lateral_speed}";
  EXPECT_THAT(refusal("", "{gain: 1}", sideways).expected,
              HasSubstr("the velocity that the loop holds"));
}

}  // namespace feedback_loop_test
}  // namespace qsmpc::harness
