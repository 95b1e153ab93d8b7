// Forecasts recomputed from a trace, and the true positions of its obstacles.
#include "harness/trace/seen_forecasts.hpp"

#include <cstddef>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/episode/drive.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/driven_obstacles.hpp"

namespace qsmpc::harness {
namespace seen_forecasts_test {

using ::testing::ElementsAre;

/// A walking obstacle, a standing one, and one that may turn.
Scenario crossing() {
  return load_scenario(
      "dubins_obstacles",
      {"plant.kind=analytic", "limit.steps=12", "limit.stop_when_unsafe=false",
       "controller.horizon=5",
       "safe_set.obstacles=["
       "{disc: {centre: [6, 3], radius: 0.3}, motion: {velocity: [-0.4, 1], "
       "speed_deviation: [0.2, 0.1], seen_deviation: 0.05}}, {x: [2, 3], y: [5, 6]}, "
       "{box: {centre: [9, 3], size: [1, 0.5], angle: 0.2}, motion: {turns: true, "
       "start_deviation: 0.1, speed_deviation: 0.1, returns_in: [0, 2], seen_deviation: 0.05, "
       "ways: [{probability: 0.7, velocity: [0, 1.5]}, "
       "{probability: 0.3, route: [[9, 4], [6, 4]], speed: 1.5}]}}]"});
}

void expect_same(const controller::ObstaclePlace& one, const controller::ObstaclePlace& other) {
  EXPECT_EQ(one.weight, other.weight);
  EXPECT_EQ(one.offset, other.offset);
  EXPECT_EQ(one.turn, other.turn);
  EXPECT_EQ(one.covariance, other.covariance);
}

TEST(SeenForecasts, are_those_that_the_drive_had) {
  const Scenario scenario = crossing();
  Drive drive(scenario);
  drive.begin({.seed = 5, .certify = false});
  std::vector<KnownForecasts> had;
  while (!drive.outcome()) {
    const controller::ObstacleForecast& forecast = *drive.scenario().safe_set.forecast;
    had.push_back({forecast.of(0), forecast.of(1)});
    drive.advance({.input = Eigen::VectorXd::Zero(1)});
  }
  const std::vector<int> stages = {0, 1, 2, 3, 4, 5};
  const std::vector<KnownForecasts> known = seen_forecasts(drive.trace(), stages);
  ASSERT_EQ(known.size(), 12U);
  ASSERT_EQ(had.size(), known.size());
  for (std::size_t k = 0; k < known.size(); ++k) {
    ASSERT_EQ(known[k].size(), 2U);
    for (std::size_t n = 0; n < 2; ++n) {
      for (const int stage : stages) {
        const auto i = static_cast<std::size_t>(stage);
        ASSERT_EQ(known[k][n][i].size(), n + 1);
        for (std::size_t way = 0; way <= n; ++way) {
          expect_same(known[k][n][i][way], had[k][n][i][way]);
        }
      }
    }
  }
  // Observations matter: the initial forecast would differ.
  EXPECT_NE(known[11][0][0][0].offset, known[0][0][5][0].offset);
  EXPECT_NE(known[11][1][0][0].weight, known[0][1][0][0].weight);
}

TEST(SeenForecasts, are_of_the_stages_that_are_asked_for) {
  Drive drive(crossing());
  drive.begin({.seed = 5, .certify = false});
  for (int k = 0; k < 3; ++k) drive.advance({.input = Eigen::VectorXd::Zero(1)});
  const auto all = seen_forecasts(drive.trace(), {0, 1, 2, 3, 4, 5});
  const auto some = seen_forecasts(drive.trace(), {1, 4});
  ASSERT_EQ(some[2][1].size(), 2U);
  expect_same(some[2][1][0][1], all[2][1][1][1]);
  expect_same(some[2][1][1][1], all[2][1][4][1]);
  EXPECT_TRUE(seen_forecasts(drive.trace(), {})[2].empty());
}

TEST(SeenForecasts, end_where_nothing_was_seen_any_more) {
  Drive drive(crossing());
  drive.begin({.seed = 5, .certify = false});
  for (int k = 0; k < 4; ++k) drive.advance({.input = Eigen::VectorXd::Zero(1)});
  Trace trace = drive.trace();
  trace.steps[2].obstacles_seen.resize(2, 0);
  const auto known = seen_forecasts(trace, {0, 5});
  EXPECT_EQ(known[1].size(), 2U);
  EXPECT_TRUE(known[2].empty());
  EXPECT_TRUE(known[3].empty());
}

TEST(SeenForecasts, stages_are_spread_with_both_ends) {
  EXPECT_THAT(spread_stages(20, 5), ElementsAre(0, 5, 10, 15, 20));
  EXPECT_THAT(spread_stages(3, 5), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(spread_stages(7, 2), ElementsAre(0, 7));
  EXPECT_THAT(spread_stages(0, 5), ElementsAre(0));
}

/// Two periods of 0.1 s in which the first obstacle moves by (1, 2) m each, and the second one
/// turns past π.
Trace turning() {
  Trace trace;
  trace.scenario = crossing();
  for (int k = 0; k < 2; ++k) {
    StepRecord& step = trace.steps.emplace_back();
    step.time = 0.1 * k;
    step.obstacles = Eigen::Matrix3Xd::Zero(3, 2);
    step.obstacles.col(0) << k, 2.0 * k, 0.0;
    step.obstacles(2, 1) = k == 0 ? 3.0 : -3.0;
  }
  trace.final_obstacles = trace.steps[1].obstacles;
  trace.final_obstacles.col(0) << 2.0, 4.0, 0.0;
  return trace;
}

TEST(DrivenObstacles, move_straight_on_and_turn_the_shorter_way_between_instants) {
  const DrivenObstacles others(turning());
  ASSERT_EQ(others.count(), 2U);
  ASSERT_EQ(others.poses().size(), 3U);
  const Eigen::Matrix3Xd early = others.poses_at(0.025);
  EXPECT_NEAR(early(0, 0), 0.25, 1e-12);
  EXPECT_NEAR(early(1, 0), 0.5, 1e-12);
  // From 3 rad past π to −3 rad, a turn of 2π − 6 rad.
  EXPECT_NEAR(early(2, 1), 3.0 + 0.25 * (2.0 * std::numbers::pi - 6.0), 1e-12);
  EXPECT_EQ(others.poses_at(0.1).col(0), Eigen::Vector3d(1.0, 2.0, 0.0));
  EXPECT_EQ(others.poses_at(7.0).col(0), Eigen::Vector3d(2.0, 4.0, 0.0));
  EXPECT_EQ(others.poses_at(-1.0).col(0), Eigen::Vector3d::Zero());
}

TEST(DrivenObstacles, are_turned_about_their_middle) {
  const DrivenObstacles others(turning());
  const auto box = std::get<controller::TurnedBoxShape>(others.shape_at(1, others.poses().front()));
  EXPECT_NEAR(box.centre.x(), 9.0, 1e-12);
  EXPECT_NEAR(box.centre.y(), 3.0, 1e-12);
  EXPECT_NEAR(box.angle, 3.2, 1e-12);
  const auto disc = std::get<controller::DiscShape>(others.shape_at(0, others.poses().back()));
  EXPECT_NEAR(disc.centre.x(), 8.0, 1e-12);
  EXPECT_NEAR(disc.centre.y(), 7.0, 1e-12);
}

TEST(DrivenObstacles, stand_where_the_trace_had_them_last) {
  Trace trace = turning();
  trace.final_obstacles.resize(3, 0);
  EXPECT_EQ(DrivenObstacles(trace).poses_at(7.0).col(0), Eigen::Vector3d(1.0, 2.0, 0.0));
  for (StepRecord& step : trace.steps) step.obstacles.resize(3, 0);
  EXPECT_EQ(DrivenObstacles(trace).poses_at(7.0), Eigen::MatrixXd::Zero(3, 2));
}

}  // namespace seen_forecasts_test
}  // namespace qsmpc::harness
