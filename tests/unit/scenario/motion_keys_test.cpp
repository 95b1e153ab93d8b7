// Moving obstacles: read, refused with place and reason, written back.
#include "harness/scenario/keys/motion_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/certificate_scope.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace motion_keys_test {

using ::testing::HasSubstr;

// Line 6 is the safe set, line 8 the first obstacle.
std::string with_obstacles(const std::string& lines) {
  return minimal_text + "safe_set:\n  obstacles:\n" + lines;
}

std::string with_motion(const std::string& motion) {
  return with_obstacles("    - {disc: {centre: [9, 9], radius: 0.5}, motion: " + motion + "}\n");
}

models::ObstacleMotion motion_of(const std::string& motion) {
  return parse_scenario(with_motion(motion)).safe_set.obstacles[0].motion.value();
}

TEST(Motions, velocity_leads_straight_on_from_where_the_shape_is) {
  const models::ObstacleMotion motion =
      motion_of("{velocity: [0.5, -0.1], covariance_rate: [0.01, 0.02]}");
  ASSERT_EQ(motion.ways.size(), 1U);
  ASSERT_EQ(motion.ways[0].points.size(), 1U);
  EXPECT_EQ(motion.ways[0].points[0].place, Eigen::Vector2d(9, 9));
  EXPECT_EQ(motion.ways[0].onward, Eigen::Vector2d(0.5, -0.1));
  EXPECT_EQ(motion.covariance_rate, Eigen::Vector2d(0.01, 0.02));
  EXPECT_TRUE(motion.speed_deviation.isZero(0.0));
}

TEST(Motions, path_has_times_and_route_a_speed) {
  const auto path = motion_of("{path: [[2, 10, 9], [3.5, 10, 12]], velocity: [0, 1]}").ways[0];
  ASSERT_EQ(path.points.size(), 3U);
  EXPECT_EQ(path.points[2].time, 3.5);
  EXPECT_EQ(path.points[2].place, Eigen::Vector2d(10, 12));
  EXPECT_EQ(path.onward, Eigen::Vector2d(0, 1));
  const auto route = motion_of("{route: [[12, 9], [12, 13]], speed: 2}").ways[0];
  ASSERT_EQ(route.points.size(), 3U);
  EXPECT_EQ(route.points[1].time, 1.5);
  EXPECT_EQ(route.points[2].time, 3.5);
  EXPECT_TRUE(route.onward.isZero(0.0));
}

TEST(Motions, one_number_stands_for_along_and_across) {
  const models::ObstacleMotion motion = motion_of(
      "{velocity: [1, 0], speed_deviation: 0.3, returns_in: [0, 2], memory: 4, "
      "start_deviation: [0.1, 0], seen_deviation: 0.05, turns: true, yields: 1.5}");
  EXPECT_EQ(motion.speed_deviation, Eigen::Vector2d(0.3, 0.3));
  EXPECT_EQ(motion.returns_in, Eigen::Vector2d(0, 2));
  EXPECT_EQ(motion.start_deviation, Eigen::Vector2d(0.1, 0));
  EXPECT_EQ(motion.memory, 4.0);
  EXPECT_EQ(motion.seen_deviation, 0.05);
  EXPECT_TRUE(motion.turns);
  EXPECT_EQ(motion.yields, 1.5);
}

TEST(Motions, survive_being_written_and_loaded) {
  expect_round_trip(parse_scenario(with_obstacles(
      "    - {disc: {centre: [0.1, 9], radius: 0.5}, motion: {velocity: [0.1, 0.3]}}\n"
      "    - {x: [7, 8], y: [1, 2]}\n"
      "    - {box: {centre: [9, 5], size: [2, 1], angle: 1}, motion: {route: [[3, 1.1], [7, 9]], "
      "speed: 0.7, turns: true}}\n"
      "    - {polygon: [[10, 0], [11, 0], [10, 1]], motion: {ways: [{probability: 0.1, velocity: "
      "[1, 0]}, {probability: 0.9, path: [[0.3, 12, 1]]}], seen_deviation: 0.1, returns_in: "
      "[0, 3]}}\n"
      "    - {half_plane: {normal: [0, 2], offset: 30}, motion: {velocity: [0, -0.1]}}\n")));
}

TEST(Motions, target_may_be_where_something_only_stands_at_first) {
  EXPECT_NO_THROW(static_cast<void>(parse_scenario(
      with_obstacles("    - {disc: {centre: [5, 0], radius: 1}, motion: {velocity: [1, 0]}}\n"))));
  EXPECT_EQ(refusal_of(with_obstacles("    - {disc: {centre: [5, 0], radius: 1}}\n")).key,
            "target.state");
}

TEST(Motions, start_may_not_be_where_something_stands_at_first) {
  const InputError::Where where = refusal_of(
      with_obstacles("    - {disc: {centre: [0, 0], radius: 1}, motion: {velocity: [1, 0]}}\n"));
  EXPECT_EQ(where.key, "initial_state.mean");
}

struct BrokenMotion {
  std::string name;
  std::string motion;
  std::string key;       ///< after "safe_set.obstacles.0.motion"
  std::string found;     ///< a piece of it
  std::string expected;  ///< a piece of it
};

class BrokenMotions : public ::testing::TestWithParam<BrokenMotion> {};

TEST_P(BrokenMotions, are_refused_with_where_and_why) {
  const BrokenMotion& broken = GetParam();
  const InputError::Where where = refusal_of(with_motion(broken.motion));
  EXPECT_EQ(where.file, "t.yaml");
  EXPECT_EQ(where.line, 8);
  EXPECT_EQ(where.key, "safe_set.obstacles.0.motion" + broken.key);
  EXPECT_THAT(where.found, HasSubstr(broken.found));
  EXPECT_THAT(where.expected, HasSubstr(broken.expected));
}

INSTANTIATE_TEST_SUITE_P(
    Entries, BrokenMotions,
    ::testing::Values(
        BrokenMotion{"number", "3", "", "3", "a mapping"},
        BrokenMotion{"misspelt", "{velocty: [1, 0]}", ".velocty", "unknown key", "velocity"},
        BrokenMotion{"speed_alone", "{speed: 1}", ".speed", "1", "none without a route"},
        BrokenMotion{"route_alone", "{route: [[1, 2]]}", ".speed", "nothing", "a speed in m/s"},
        BrokenMotion{"path_and_route", "{path: [[1, 2, 3]], route: [[1, 2]], speed: 1}", ".route",
                     "a list", "no route beside a path"},
        BrokenMotion{"two_at_once", "{path: [[1, 10, 9], [1, 11, 9]]}", "", "another motion",
                     "ascending times"},
        BrokenMotion{"at_once", "{path: [[0, 10, 9]]}", "", "another motion", "the first above 0"},
        BrokenMotion{"jump", "{path: [[0.01, 19, 9]]}", "", "another motion", "must not jump"},
        BrokenMotion{"nothing", "{}", "", "an empty mapping", "a velocity or a route"},
        BrokenMotion{"short_row", "{path: [[1, 10]]}", ".path.0", "", "[time, x, y]"},
        BrokenMotion{"no_places", "{path: []}", ".path", "", "1 to 1000 places"},
        BrokenMotion{"negative", "{speed_deviation: -1}", ".speed_deviation", "-1", ">= 0"},
        BrokenMotion{"negative_pair", "{speed_deviation: [1, -1]}", ".speed_deviation", "[1, -1]",
                     "two numbers from 0"},
        BrokenMotion{"no_memory", "{memory: 0}", ".memory", "0", ">= 0.001"},
        BrokenMotion{"ways_and_velocity",
                     "{velocity: [1, 0], ways: [{probability: 1, velocity: [1, 0]}]}", ".velocity",
                     "a list", "none beside ways"},
        BrokenMotion{"no_ways", "{ways: []}", ".ways", "", "1 to 10 ways"},
        BrokenMotion{"no_probability", "{ways: [{velocity: [1, 0]}]}", ".ways.0.probability",
                     "nothing", "its probability"},
        BrokenMotion{"probabilities",
                     "{seen_deviation: 0.1, ways: [{probability: 0.5, velocity: [1, 0]}, "
                     "{probability: 0.4, velocity: [0, 1]}]}",
                     "", "another motion", "add up to 1"},
        BrokenMotion{"seen_exactly",
                     "{ways: [{probability: 0.5, velocity: [1, 0]}, "
                     "{probability: 0.5, velocity: [0, 1]}]}",
                     "", "another motion", "a seen_deviation above 0"}),
    [](const auto& each) { return each.param.name; });

TEST(Motions, that_answer_to_the_vehicle_leave_no_bound) {
  EXPECT_EQ(why_no_bound(parse_scenario(with_motion("{velocity: [1, 0]}"))), "");
  EXPECT_THAT(why_no_bound(parse_scenario(with_motion("{velocity: [1, 0], yields: 2}"))),
              HasSubstr("motion.yields"));
}

TEST(Motions, of_a_box_of_states_are_refused) {
  const InputError::Where where =
      refusal_of(with_obstacles("    - {x: [7, 8], motion: {velocity: [1, 0]}}\n"));
  EXPECT_EQ(where.key, "safe_set.obstacles.0.motion");
  EXPECT_THAT(where.expected, HasSubstr("only these can move"));
}

}  // namespace motion_keys_test
}  // namespace qsmpc::harness
