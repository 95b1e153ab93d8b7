// Obstacles' ways: positions, headings, and refused ways.
#include "models/motion/obstacle_motion.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/motion/obstacle_poses.hpp"

namespace qsmpc::models {
namespace obstacle_motion_test {

/// East for 2 s at 1 m/s, then north at 2 m/s for 1 s, and on to the west.
IntendedWay bent_way() {
  return {.points = {{.time = 0.0, .place = {5.0, 1.0}},
                     {.time = 2.0, .place = {7.0, 1.0}},
                     {.time = 3.0, .place = {7.0, 3.0}}},
          .onward = {-1.0, 0.0}};
}

TEST(ObstacleMotion, way_leads_from_place_to_place_and_on) {
  const IntendedWay way = bent_way();
  EXPECT_TRUE(intended_offset(way, 0.0).isZero(0.0));
  EXPECT_TRUE(intended_offset(way, 0.5).isApprox(Eigen::Vector2d(0.5, 0.0)));
  EXPECT_TRUE(intended_offset(way, 2.25).isApprox(Eigen::Vector2d(2.0, 0.5)));
  EXPECT_TRUE(intended_offset(way, 5.0).isApprox(Eigen::Vector2d(0.0, 2.0)));
}

TEST(ObstacleMotion, direction_is_that_of_the_way_and_turns_within_a_second) {
  const IntendedWay way = bent_way();
  EXPECT_DOUBLE_EQ(way_direction(way, 1.0), 0.0);
  EXPECT_DOUBLE_EQ(way_direction(way, 2.5), 0.5 * std::numbers::pi);
  EXPECT_NEAR(way_direction(way, 2.0), std::atan2(1.0, 0.5), 1e-12);
  EXPECT_DOUBLE_EQ(std::abs(way_direction(way, 9.0)), std::numbers::pi);
}

TEST(ObstacleMotion, what_has_stopped_faces_the_way_it_came) {
  IntendedWay way = bent_way();
  way.onward.setZero();
  EXPECT_DOUBLE_EQ(way_direction(way, 20.0), 0.5 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(way_direction(IntendedWay{}, 3.0), 0.0);
  // An obstacle that waits at first faces the way it will go.
  const IntendedWay late{.points = {{.time = 0.0}, {.time = 4.0}}, .onward = {0.0, -1.0}};
  EXPECT_DOUBLE_EQ(way_direction(late, 1.0), -0.5 * std::numbers::pi);
}

TEST(ObstacleMotion, way_along_places_keeps_its_speed) {
  Eigen::Matrix2Xd places(2, 4);
  places << 1.0, 4.0, 4.0, 4.0,  //
      1.0, 1.0, 1.0, 5.0;
  const IntendedWay way = way_along(places, 2.0);
  ASSERT_EQ(way.points.size(), 3U);  // a place named twice counts once
  EXPECT_DOUBLE_EQ(way.points[1].time, 1.5);
  EXPECT_DOUBLE_EQ(way.points[2].time, 3.5);
  EXPECT_TRUE(intended_offset(way, 100.0).isApprox(Eigen::Vector2d(3.0, 4.0)));
}

TEST(ObstacleMotion, deviation_of_the_rate_stays_what_it_is) {
  const ObstacleMotion motion{.speed_deviation = {0.3, 0.1}, .memory = 0.7};
  for (const int direction : {0, 1}) {
    const DeviationStep step = deviation_step(motion, direction, 0.2);
    const double deviation = motion.speed_deviation[direction];
    EXPECT_NEAR(std::pow(step.memory * deviation, 2) + std::pow(step.rate_noise, 2),
                deviation * deviation, 1e-15);
  }
}

TEST(ObstaclePoses, are_straight_between_two_and_turn_the_shorter_way) {
  const Eigen::Matrix3Xd first = Eigen::Vector3d(1.0, 2.0, 3.0);
  const Eigen::Matrix3Xd last = Eigen::Vector3d(3.0, 1.0, -3.0);
  const Eigen::Matrix3Xd between = poses_between(first, last, 0.5);
  EXPECT_TRUE(between.topRows<2>().isApprox(Eigen::Vector2d(2.0, 1.5)));
  EXPECT_NEAR(between(2, 0), std::numbers::pi, 1e-12);
  EXPECT_EQ(poses_between(first, last, 0.0), first);
}

/// A valid motion, and the change that makes it invalid.
struct Wrong {
  std::string name;
  std::string expected;
  std::function<void(ObstacleMotion&)> spoil;
};

class WrongMotion : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongMotion, is_refused_with_what_is_expected) {
  ObstacleMotion motion{.ways = {bent_way(), bent_way()}, .seen_deviation = 0.1};
  motion.ways[0].probability = motion.ways[1].probability = 0.5;
  ASSERT_NO_THROW(check_obstacle_motion(motion));
  GetParam().spoil(motion);
  try {
    check_obstacle_motion(motion);
    FAIL() << "it was taken";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), ::testing::HasSubstr(GetParam().expected));
  }
}

INSTANTIATE_TEST_SUITE_P(
    each, WrongMotion,
    ::testing::Values(
        Wrong{"no_ways", "at least one way", [](auto& m) { m.ways.clear(); }},
        Wrong{"probabilities", "add up to 1", [](auto& m) { m.ways[0].probability = 0.4; }},
        Wrong{"no_probability", "above 0", [](auto& m) { m.ways[0].probability = 0.0; }},
        Wrong{"seen_exactly", "where there are several", [](auto& m) { m.seen_deviation = 0.0; }},
        Wrong{"apart", "begin at the same place",
              [](auto& m) { m.ways[1].points[0].place.x() = 4.9; }},
        Wrong{"two_at_once", "ascending times", [](auto& m) { m.ways[0].points[2].time = 2.0; }},
        Wrong{"jump", "must not jump", [](auto& m) { m.ways[0].points[2].time = 2.01; }},
        Wrong{"late", "begins at time 0", [](auto& m) { m.ways[0].points[0].time = 0.5; }},
        Wrong{"too_fast", "100 m/s", [](auto& m) { m.ways[0].onward.x() = 200.0; }},
        Wrong{"negative", "0 or above", [](auto& m) { m.speed_deviation.x() = -0.1; }},
        Wrong{"no_memory", "memory above 0", [](auto& m) { m.memory = 0.0; }},
        Wrong{"not_finite", "finite", [](auto& m) { m.ways[1].points[1].place.x() = NAN; }}),
    [](const auto& each) { return each.param.name; });

}  // namespace obstacle_motion_test
}  // namespace qsmpc::models
