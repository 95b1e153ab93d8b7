// Waypoints in the scenario.
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace waypoint_keys_test {

using ::testing::HasSubstr;

/// minimal_text with another target in line 5.
std::string with_target(const std::string& target) {
  std::string text = minimal_text;
  const std::string old = "target: {state: [5, 0, 0]}";
  return text.replace(text.find(old), old.size(), "target: " + target);
}

Scenario over(const std::string& target) {
  Scenario scenario = parse_scenario(with_target(target), {.file = "t.yaml"});
  expect_round_trip(scenario);
  return scenario;
}

TEST(WaypointKeys, places_have_the_heading_of_the_way_to_them) {
  const Scenario scenario = over("{waypoints: [[4, 0], [4, 4], [0, 4], [0, 0], [4, 0.1]]}");
  ASSERT_TRUE(scenario.target.route.has_value());
  const Eigen::MatrixXd& states = scenario.target.route->states;
  ASSERT_EQ(states.cols(), 5);
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  EXPECT_NEAR(states(2, 0), 0.0, 1e-12);
  EXPECT_NEAR(states(2, 1), kQuarter, 1e-12);
  EXPECT_NEAR(states(2, 2), 2.0 * kQuarter, 1e-12);
  EXPECT_NEAR(states(2, 3), 3.0 * kQuarter, 1e-12) << "without a jump";
  EXPECT_NEAR(states(2, 4), 4.0 * kQuarter, 0.03);
  EXPECT_EQ(scenario.target.state, states.col(4)) << "the drive ends at the last";
  EXPECT_EQ(scenario.target.route->radius, scenario.target.radius);
}

TEST(WaypointKeys, may_be_whole_states_and_have_a_radius_of_their_own) {
  const Scenario scenario =
      over("{waypoints: [[4, 0, 1.5], [4, 4]], radius: 0.3, waypoint_radius: 0.8}");
  EXPECT_EQ(scenario.target.route->states(2, 0), 1.5);
  EXPECT_EQ(scenario.target.route->radius, 0.8);
  EXPECT_EQ(scenario.target.radius, 0.3);
}

struct WrongWaypoints {
  std::string target;
  std::string key;
  std::string found;
  std::string expected;
};

TEST(WaypointKeys, errors_are_reported_in_one_line) {
  for (const WrongWaypoints& wrong : std::initializer_list<WrongWaypoints>{
           {"{waypoints: []}", "target.waypoints", "0 waypoints", "1 to 1000 waypoints"},
           {"{waypoints: 5}", "target.waypoints", "5", "a list"},
           {"{waypoints: [[4, 0], 5]}", "target.waypoints.1", "5", "[x, y], or 3 numbers"},
           {"{waypoints: [[4, 0], [1, 2, 3, 4]]}", "target.waypoints.1", "", "[x, y]"},
           {"{waypoints: [[4, 0], [4, .inf]]}", "target.waypoints.1", ".inf at position 2",
            "[x, y]"},
           {"{waypoints: [[4, 0], [4, 0]]}", "target.waypoints.1", "(4, 0) again", "a place other"},
           {"{waypoints: [[4, 0], [2e9, 0]]}", "target.waypoints.1", "", "at most 1e+09"},
           {"{waypoints: [[4, 0]], path: [[0, 0], [5, 0]]}", "target.waypoints", "", "one of them"},
           {"{waypoints: [[4, 0]], state: [5, 0, 0]}", "target.state", "", "target.waypoints"},
           {"{waypoints: [[4, 0]], waypoint_radius: 0}", "target.waypoint_radius", "0", "> 0"},
           {"{state: [5, 0, 0], waypoint_radius: 1}", "target.waypoint_radius", "1",
            "target.waypoints"}}) {
    SCOPED_TRACE(wrong.target);
    const InputError::Where where = refusal_of(with_target(wrong.target));
    EXPECT_EQ(where.key, wrong.key);
    EXPECT_EQ(where.line, 5);
    EXPECT_THAT(where.found, HasSubstr(wrong.found));
    EXPECT_THAT(where.expected, HasSubstr(wrong.expected));
  }
}

TEST(WaypointKeys, each_must_be_safe) {
  const std::string map =
      "safe_set: {bounds: {x: [-9, 9], y: [-9, 9]}, obstacles: [{disc: {centre: [3, 3], radius: "
      "1}}]}\n";
  const InputError::Where inside =
      refusal_of(with_target("{waypoints: [[4, 0], [3.5, 3], [5, 5]]}") + map);
  EXPECT_EQ(inside.key, "target.waypoints.1");
  EXPECT_THAT(inside.found, HasSubstr("safe_set.obstacles.0"));
  const InputError::Where outside =
      refusal_of(with_target("{waypoints: [[4, 0], [9.5, 3], [5, 5]]}") + map);
  EXPECT_EQ(outside.key, "target.waypoints.1");
  EXPECT_THAT(outside.found, HasSubstr("outside of the bounds"));
}

TEST(WaypointKeys, what_does_not_drive_over_them_is_refused) {
  const auto refused_with = [](const std::string& controller) {
    return refusal_of(with_target("{waypoints: [[4, 0], [5, 5]]}") + "controller: " + controller +
                      "\n")
        .key;
  };
  EXPECT_EQ(refused_with("{kind: lqr, lqr: {about: target}}"), "target.waypoints");
  EXPECT_EQ(refusal_of("name: t\nmodel: {system: cart_pole}\nplant: {kind: analytic, mjcf: \"\"}\n"
                       "initial_state: {mean: [0, 0, 0, 0]}\ntarget: {waypoints: [[1, 0]]}\n")
                .key,
            "target.waypoints");
}

}  // namespace waypoint_keys_test
}  // namespace qsmpc::harness
