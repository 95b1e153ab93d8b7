// Messages to external controllers, and which of their answers are accepted.
#include "harness/control/controller_protocol.hpp"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/assembly/assembly.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/unit/control/outside_fixture.hpp"

namespace qsmpc::harness {
namespace controller_protocol_test {

using ::testing::HasSubstr;

nlohmann::json message_of(const Scenario& scenario) {
  return nlohmann::json::parse(scenario_message(scenario, model_of(scenario)->description()));
}

TEST(ControllerProtocol, tells_the_resolved_scenario) {
  const Scenario scenario = outside_scenario(
      OutsideKind::kExternal,
      {"controller.options={lookahead: 0.8, names: [a, \"1\", 1, true, null]}", "risk.plan=0.02",
       "vehicle.footprint=[{radius: 0.1, offset: [0.2, 0]}]", "model.speed=1.25"});
  const nlohmann::json json = message_of(scenario);
  EXPECT_EQ(json["type"], "scenario");
  EXPECT_EQ(json["protocol"], kProtocolVersion);
  EXPECT_EQ(json["time_step"], scenario.time_step);
  EXPECT_EQ(json["system"]["parameters"]["speed"], 1.25);
  EXPECT_EQ(json["system"]["states"][2],
            nlohmann::json::parse(R"({"name": "heading", "unit": "rad", "angle": true})"));
  EXPECT_EQ(json["system"]["inputs"][0]["upper"], scenario.controller.input_upper[0]);
  EXPECT_EQ(json["safe_set"]["lower"][0], scenario.safe_set.bounds.lower[0]);
  EXPECT_TRUE(json["safe_set"]["lower"][2].is_null()) << "no bound of the heading";
  EXPECT_EQ(json["safe_set"]["obstacles"].size(), scenario.safe_set.obstacles.size());
  EXPECT_EQ(json["footprint"], nlohmann::json::parse(R"([{"radius": 0.1, "offset": [0.2, 0.0]}])"));
  EXPECT_EQ(json["risk"]["plan"], 0.02);
  EXPECT_TRUE(json["risk"]["mission"].is_null());
  EXPECT_EQ(json["deadline"], 10.0) << "where the scenario has none";
  EXPECT_EQ(json["options"],
            nlohmann::json::parse(R"({"lookahead": 0.8, "names": ["a", "1", 1, true, null]})"));
}

TEST(ControllerProtocol, tells_shapes_as_the_scenario_has_them) {
  const Scenario scenario = outside_scenario(
      OutsideKind::kExternal,
      {"safe_set.obstacles=[{disc: {centre: [8, 3], radius: 0.5}}, {y: [10, 11]}, {ellipse: "
       "{centre: [8, 6], semi_axes: [1, 0.5]}}, {box: {centre: [3, 6], size: [1, 2], angle: 0.4}}, "
       "{polygon: [[5, 9], [6, 9], [6, 10]]}, {half_plane: {normal: [0, -1], offset: 0.75}}]"});
  const nlohmann::json obstacles = message_of(scenario)["safe_set"]["obstacles"];
  ASSERT_EQ(obstacles.size(), 6U);
  EXPECT_EQ(obstacles[0],
            nlohmann::json::parse(R"({"disc": {"centre": [8.0, 3.0], "radius": 0.5}})"));
  EXPECT_EQ(obstacles[1]["lower"][1], 10.0);
  EXPECT_EQ(obstacles[2]["ellipse"]["angle"], 0.0);
  EXPECT_EQ(obstacles[3]["box"]["size"][1], 2.0);
  EXPECT_EQ(obstacles[4],
            nlohmann::json::parse(R"({"polygon": [[5.0, 9.0], [6.0, 9.0], [6.0, 10.0]]})"));
  EXPECT_EQ(obstacles[5]["half_plane"]["normal"][1], -1.0);
}

TEST(ControllerProtocol, tells_a_situation_with_numbers_that_read_back_as_the_same) {
  const controller::Gaussian belief{.mean = Eigen::Vector3d(0.1, 1.0 / 3.0, -2e-17),
                                    .covariance = Eigen::Matrix3d::Identity() / 7.0};
  const Eigen::VectorXd seen = Eigen::Vector3d(0.1 + 0.2, 0.0, 1e300);
  const auto json = nlohmann::json::parse(situation_message(
      {.period = 4, .time = 0.4, .belief = belief, .observation = seen, .periods_left = 9}, 0.5));
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(json["observation"][at], seen[i]);
    EXPECT_EQ(json["belief"]["mean"][at], belief.mean[i]);
    EXPECT_EQ(json["belief"]["covariance"][at][at], belief.covariance(i, i));
  }
  EXPECT_EQ(json["period"], 4);
  EXPECT_EQ(json["periods_left"], 9);
  EXPECT_EQ(json["deadline"], 0.5);
}

TEST(ControllerProtocol, tells_what_is_known_of_obstacles_that_move) {
  const controller::Gaussian belief{.mean = Eigen::Vector2d::Zero(),
                                    .covariance = Eigen::Matrix2d::Identity()};
  const Eigen::VectorXd seen = Eigen::Vector2d::Zero();
  controller::ObstacleForecast forecast(1);
  const controller::ObstaclePlace left{.weight = 0.25, .offset = {1.0, 2.0}, .turn = 0.5};
  const controller::ObstaclePlace right{
      .weight = 0.75, .covariance = (Eigen::Matrix2d() << 0.3, 0.1, 0.1, 0.2).finished()};
  forecast.set(0, {{left, right}, {right, left}});
  const auto json = nlohmann::json::parse(
      situation_message({.belief = belief, .observation = seen, .obstacles = &forecast}, 1.0));
  const auto& stages = json["obstacles"][0];
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[0][0]["weight"], 0.25);
  EXPECT_EQ(stages[0][0]["offset"][1], 2.0);
  EXPECT_EQ(stages[0][0]["turn"], 0.5);
  EXPECT_EQ(stages[1][0]["covariance"][0][1], 0.1);
  const auto without =
      nlohmann::json::parse(situation_message({.belief = belief, .observation = seen}, 1.0));
  EXPECT_FALSE(without.contains("obstacles"));
}

TEST(ControllerProtocol, tells_waypoints_as_states_and_where_they_count_as_passed) {
  const Scenario scenario = outside_scenario(
      OutsideKind::kExternal,
      {"target={waypoints: [[1, 0, 0.25], [2, 0.5, 0.5]], radius: 0.3, waypoint_radius: 0.8}"});
  const nlohmann::json target = message_of(scenario)["target"];
  EXPECT_EQ(target["waypoints"], nlohmann::json::parse("[[1.0, 0.0, 0.25], [2.0, 0.5, 0.5]]"));
  EXPECT_EQ(target["waypoint_radius"], 0.8);
  EXPECT_EQ(target["radius"], 0.3);
}

TEST(ControllerProtocol, tells_how_many_waypoints_were_passed) {
  const controller::Gaussian belief{.mean = Eigen::Vector2d::Zero(),
                                    .covariance = Eigen::Matrix2d::Identity()};
  const Eigen::VectorXd seen = Eigen::Vector2d::Zero();
  const auto told = nlohmann::json::parse(
      situation_message({.belief = belief, .observation = seen, .progress = 3.0}, 1.0));
  EXPECT_EQ(told["waypoints_passed"], 3);
  const auto without =
      nlohmann::json::parse(situation_message({.belief = belief, .observation = seen}, 1.0));
  EXPECT_FALSE(without.contains("waypoints_passed"));
}

/// Two states and two inputs from -1 to 1.
class Answers : public ::testing::Test {
 protected:
  Answers() {
    system_.states = {{.name = "x", .unit = "m"}, {.name = "v", .unit = "m/s"}};
    system_.inputs = {{.name = "a", .unit = "m/s^2"}, {.name = "b", .unit = "m"}};
  }
  [[nodiscard]] ControllerAnswer read(const std::string& line, int stages = 0) const {
    return read_answer(line, 3, {.system = system_, .bounds = bounds_, .stages = stages});
  }
  [[nodiscard]] std::string refusal(const std::string& line, int stages = 0) const {
    try {
      (void)read(line, stages);
    } catch (const WrongAnswer& wrong) {
      return wrong.found + "; " + wrong.expected;
    }
    return "accepted";
  }

  models::SystemDescription system_;
  controller::InputBounds bounds_{.lower = Eigen::Vector2d(-1, -1), .upper = Eigen::Vector2d(1, 1)};
};

TEST_F(Answers, that_are_inputs_within_the_bounds_are_taken_as_they_are) {
  EXPECT_EQ(read(R"({"input": [1, -0.25], "period": 3, "more": {}})").input,
            Eigen::Vector2d(1.0, -0.25));
}

TEST_F(Answers, that_are_plans_have_no_gains_unless_given) {
  const ControllerAnswer open = read(R"({"plan": {"inputs": [[0, 1], [1, 0]]}})", 2);
  EXPECT_EQ(open.policy.inputs.col(0), Eigen::Vector2d(0, 1));
  ASSERT_EQ(open.policy.gains.size(), 2U);
  EXPECT_TRUE(open.policy.gains[1].isZero(0.0));
  EXPECT_EQ(open.status, controller::SolverStatus::kConverged);
  const ControllerAnswer closed = read(
      R"({"plan": {"inputs": [[0, 1]], "gains": [[[1, 2], [3, 4]]], "status": "deadline"}})", 1);
  EXPECT_EQ(closed.policy.gains[0](0, 1), 2.0);
  EXPECT_EQ(closed.policy.gains[0](1, 0), 3.0);
  EXPECT_EQ(closed.status, controller::SolverStatus::kDeadline);
}

TEST_F(Answers, report_a_belief_only_if_they_choose_to) {
  EXPECT_EQ(read(R"({"input": [0, 0]})").believed, std::nullopt);
  EXPECT_EQ(read(R"({"input": [0, 0], "believed": null})").believed, std::nullopt);
  EXPECT_EQ(read(R"({"input": [0, 0], "believed": 0.25})").believed, 0.25);
  EXPECT_EQ(read(R"({"plan": {"inputs": [[0, 1]]}, "believed": 1})", 1).believed, 1.0);
  EXPECT_EQ(refusal(R"({"input": [0, 0], "believed": 1.5})"),
            "believed 1.5; a probability from 0 to 1");
  EXPECT_THAT(refusal(R"({"input": [0, 0], "believed": "no"})"), HasSubstr("believed \"no\"; "));
}

TEST_F(Answers, that_are_wrong_are_refused_with_what_was_found) {
  EXPECT_EQ(refusal(""), "an answer that is not JSON: ; {\"input\": […]}");
  EXPECT_THAT(refusal(R"({"input": [NaN, 0]})"), HasSubstr("not JSON: {\"input\": [NaN, 0]}"));
  EXPECT_THAT(refusal(R"({"input": 1})"), HasSubstr("input 1; 2 finite numbers"));
  EXPECT_THAT(refusal(R"({"input": [1]})"), HasSubstr("input of 1 numbers: [1]; 2 finite numbers"));
  EXPECT_THAT(refusal(R"({"input": [1, null]})"), HasSubstr("input [1,null]; 2 finite numbers"));
  EXPECT_EQ(refusal(R"({"input": [0, 1.5]})"),
            "input with b = 1.5, out of its bounds; b from -1 to 1");
  EXPECT_THAT(refusal(R"({"input": [0, 0], "period": 2})"), HasSubstr("an answer for period 2"));
  EXPECT_THAT(refusal(R"({"input": [0, 0], "error": "lost"})"), HasSubstr("its error: lost"));
  EXPECT_THAT(refusal(R"({"input": [0, 0]})", 2),
              HasSubstr("the answer {\"input\":[0,0]}; {\"plan\""));
  EXPECT_THAT(refusal(R"({"plan": {"inputs": [[0, 0]]}})", 2),
              HasSubstr("plan.inputs of 1 stages"));
  EXPECT_THAT(refusal(R"({"plan": {"inputs": [[0, 0], [0, 7]]}})", 2),
              HasSubstr("plan.inputs[1] with b = 7"));
  EXPECT_THAT(
      refusal(R"({"plan": {"inputs": [[0, 0]], "gains": [[[1, 2], [3, 4]], [[1, 2], [3, 4]]]}})",
              1),
      HasSubstr("plan.gains [[[1,2],[3,4]],[[1,2],[3,4]]]; the gains of 1 stages"));
  EXPECT_THAT(refusal(R"({"plan": {"inputs": [[0, 0]], "gains": [[[1, 2]]]}})", 1),
              HasSubstr("plan.gains[0] [[1,2]]; 2 rows of 2 numbers"));
  EXPECT_THAT(refusal(R"({"plan": {"inputs": [[0, 0]], "status": "fine"}})", 1),
              HasSubstr("plan.status \"fine\"; converged, "));
  EXPECT_THAT(refusal(R"({"plan": {"inputs": [[0, 0]], "evaluations": -1}})", 1),
              HasSubstr("plan.evaluations -1"));
  EXPECT_NE(refusal(std::string(100'000, '[')), "accepted");
}

}  // namespace controller_protocol_test
}  // namespace qsmpc::harness
