// Moving obstacles, on the map of an episode and in the data of its page.
#include "harness/report/driven_ways.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/episode_map.hpp"
#include "harness/report/episode_page.hpp"
#include "harness/report/moving_data.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/unit/report/packed_data.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace driven_ways_test {

using testing::contains;
using testing::numbers_of;

constexpr std::size_t kSteps = 6;
constexpr std::size_t kNearest = 4;  // the control instant at which it is on the vehicle's path

/// The example, and a disc that comes down (along −y) onto the vehicle and continues.
Trace met_trace() {
  Trace trace = testing::example_trace({.steps = kSteps});
  controller::Obstacle walker(controller::DiscShape{.centre = {2.0, 6.0}, .radius = 0.3});
  walker.motion = models::ObstacleMotion{.ways = {models::steady_way({0.0, -15.0})},
                                         .start_deviation = {3.0, 3.0},
                                         .speed_deviation = {0.2, 0.1},
                                         .seen_deviation = 0.05};
  trace.scenario.safe_set.obstacles.push_back(walker);
  const Eigen::Vector2d met = trace.steps[kNearest].state.head<2>();
  const auto pose = [&](std::size_t k) {
    const double apart = 1.5 * (static_cast<double>(kNearest) - static_cast<double>(k));
    return Eigen::Vector3d(met.x() - 2.0, met.y() + apart - 6.0, 0.1 * static_cast<double>(k));
  };
  for (std::size_t k = 0; k < kSteps; ++k) {
    trace.steps[k].obstacles = pose(k);
    trace.steps[k].obstacles_seen = pose(k).head<2>();
  }
  trace.final_obstacles = pose(kSteps);
  return trace;
}

MapPoint middle_of(const MapPolygon& polygon) {
  MapPoint middle;
  const auto count = static_cast<double>(polygon.corners.size());
  for (const MapPoint& corner : polygon.corners) {
    middle.x += corner.x / count;
    middle.y += corner.y / count;
  }
  return middle;
}

TEST(DrivenWays, have_the_obstacle_at_the_start_the_end_and_where_the_vehicle_was_nearest) {
  const Trace trace = met_trace();
  const EpisodeView view(trace);
  const std::vector<MapMover> movers = driven_ways(view, DrivenObstacles(trace));
  ASSERT_EQ(movers.size(), 1U);
  const Eigen::Vector2d met = trace.steps[kNearest].state.head<2>();
  ASSERT_EQ(movers[0].way.size(), kSteps + 1);
  EXPECT_NEAR(movers[0].way[1].y, met.y() + 4.5, 1e-9);
  EXPECT_NEAR(middle_of(movers[0].start).y, met.y() + 6.0, 1e-9);
  EXPECT_NEAR(middle_of(movers[0].nearest).x, met.x(), 1e-9);
  EXPECT_NEAR(middle_of(movers[0].nearest).y, met.y(), 1e-9);
  EXPECT_NEAR(middle_of(movers[0].end).y, met.y() - 3.0, 1e-9);
}

TEST(DrivenWays, of_the_map_stand_nowhere_as_obstacles) {
  const Trace trace = met_trace();
  const EpisodeView view(trace);
  const EpisodeMaps maps = episode_maps(view).value();
  EXPECT_EQ(maps.drive.movers.size(), 1U);
  EXPECT_TRUE(maps.ground.movers.empty());
  EXPECT_TRUE(maps.drive.polygons.empty());
  EXPECT_EQ(maps.drive.obstacles.size(), 2U);
  const std::vector<MapMover> written = written_movers(trace.scenario.safe_set);
  ASSERT_EQ(written.size(), 1U);
  EXPECT_NEAR(middle_of(written[0].start).y, 6.0, 1e-9);
  EXPECT_TRUE(written[0].way.empty());
}

TEST(MovingData, has_middles_turns_and_forecasts_period_by_period) {
  const Trace trace = met_trace();
  const EpisodeView view(trace);
  const nlohmann::json json = moving_data(view, DrivenObstacles(trace));
  const auto outline = numbers_of<float>(json["outlines"][0]);
  EXPECT_NEAR(outline[0], 0.3, 1e-6);  // about the middle
  const auto poses = numbers_of<float>(json["poses"]);
  ASSERT_EQ(poses.size(), 3 * (kSteps + 1));
  const Eigen::Vector2d met = trace.steps[kNearest].state.head<2>();
  EXPECT_NEAR(poses[3 * kNearest], met.x(), 1e-6);
  EXPECT_NEAR(poses[3 * kNearest + 1], met.y(), 1e-6);
  EXPECT_NEAR(poses[3 * kNearest + 2], 0.4, 1e-6);
  EXPECT_EQ(json["ways"], 1);
  const auto stages = json["stages"].get<std::vector<int>>();
  EXPECT_EQ(stages, (std::vector<int>{0, 1, 2, 3}));
  const auto places = numbers_of<float>(json["places"]);
  ASSERT_EQ(places.size(), 5 * stages.size() * kSteps);
  EXPECT_EQ(numbers_of<float>(json["weights"]), std::vector<float>(kSteps, 1.0F));
  // It is observed to within 5 cm; an uncertain velocity widens its predicted place.
  const float* const first = &places[5 * stages.size() * 1];
  EXPECT_NEAR(first[1], poses[3 * 1 + 1], 0.2);
  EXPECT_LT(first[4], 0.0026F);
  EXPECT_GT(first[5 * 3 + 4], first[4]);
}

TEST(MovingData, has_no_forecast_of_a_period_without_a_plan) {
  Trace trace = met_trace();
  trace.steps[2].plan_states.resize(3, 0);
  const EpisodeView view(trace);
  const nlohmann::json json = moving_data(view, DrivenObstacles(trace));
  const auto weights = numbers_of<float>(json["weights"]);
  EXPECT_TRUE(std::isnan(weights[2]));
  EXPECT_EQ(weights[3], 1.0F);
}

TEST(MovingData, of_a_page_has_a_switch_only_where_there_are_forecasts) {
  const Trace trace = met_trace();
  const std::string page = episode_page(EpisodeView(trace), {});
  EXPECT_TRUE(contains(page, "data-layer=\"forecast\""));
  EXPECT_TRUE(contains(page, "the moving obstacles"));
  const Trace still = testing::example_trace();
  const std::string other = episode_page(EpisodeView(still), {});
  EXPECT_FALSE(contains(other, "data-layer=\"forecast\""));
  EXPECT_FALSE(contains(other, "the moving obstacles"));
}

}  // namespace driven_ways_test
}  // namespace qsmpc::harness
