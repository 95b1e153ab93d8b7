// Drives among moving obstacles: their positions, observations, estimates and records, and what
// decides how a drive ends.
#include "harness/episode/moving_obstacles.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/true_places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace moving_obstacles_test {

constexpr const char* kWalker =
    "{disc: {centre: [1.2, 4], radius: 0.3}, motion: {velocity: [0, -1], speed_deviation: 0.2, "
    "seen_deviation: 0.1}}";
constexpr const char* kUndecided =
    "{box: {centre: [3, -4], size: [0.6, 0.3], angle: 1.5708}, motion: {ways: [{probability: 0.5, "
    "route: [[3, -2], [6, -2]], speed: 1.5}, {probability: 0.5, velocity: [0, 1]}], turns: true, "
    "speed_deviation: [0.1, 0.02], seen_deviation: 0.05}}";

Scenario scenario_with(const std::string& obstacles, std::vector<std::string> more = {}) {
  std::vector<std::string> overrides = {
      "controller.horizon=4",
      "controller.quantisation={state: 20, noise: 20, "
      "compressed: 20}",
      "limit={steps: 12}",
      "plant.kind=analytic",
      "vehicle.footprint=[{radius: 0.2}]",
      "safe_set={bounds: {x: [-5, 20], y: [-12, 12]}, obstacles: [" + obstacles + "]}"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario("dubins_obstacles", overrides);
}

Scenario crossing(std::vector<std::string> more = {}) {
  return scenario_with(std::string(kWalker) + ", " + kUndecided, std::move(more));
}

TEST(MovingObstacles, are_recorded_where_they_are_and_as_they_are_seen) {
  const Trace trace = run_episode(crossing(), {.seed = 5});
  ASSERT_GE(trace.steps.size(), 8U);
  double moved = 0.0;
  double misseen = 0.0;
  for (const StepRecord& step : trace.steps) {
    ASSERT_EQ(step.obstacles.cols(), 2);
    moved = step.obstacles(1, 0);
    misseen += (step.obstacles_seen.col(0) - step.obstacles.col(0).head<2>()).squaredNorm();
  }
  const auto periods = static_cast<double>(trace.steps.size());
  EXPECT_NEAR(moved, -0.1 * (periods - 1.0), 0.6);
  EXPECT_NEAR(std::sqrt(misseen / (2.0 * periods)), 0.1, 0.06);
  EXPECT_EQ(trace.final_obstacles.cols(), 2);
  EXPECT_EQ(trace.scenario.safe_set.forecast, nullptr);
}

TEST(MovingObstacles, of_a_seed_are_the_same_and_of_others_are_not) {
  const Scenario scenario = crossing();
  EpisodeDriver driver(scenario);
  const Trace first = driver.run({.seed = 1});
  const Trace other = driver.run({.seed = 2});
  const Trace again = driver.run({.seed = 1});
  ASSERT_EQ(first.steps.size(), again.steps.size());
  for (std::size_t k = 0; k < first.steps.size(); ++k) {
    EXPECT_EQ(first.steps[k].obstacles, again.steps[k].obstacles);
    EXPECT_EQ(first.steps[k].obstacles_seen, again.steps[k].obstacles_seen);
    EXPECT_EQ(first.steps[k].input, again.steps[k].input);
    EXPECT_EQ(first.steps[k].certificates[0].value, again.steps[k].certificates[0].value);
  }
  EXPECT_NE(first.steps[3].obstacles, other.steps[3].obstacles);
  // Obstacles in the same initial positions but with different motions: the plant's disturbances.
  const Trace plant = driver.run({.seed = 1, .plant_seed = 9});
  EXPECT_EQ(first.steps[0].obstacles, plant.steps[0].obstacles);
  EXPECT_NE(first.steps[3].obstacles, plant.steps[3].obstacles);
}

TEST(MovingObstacles, go_each_of_their_ways_as_often_as_it_is_probable) {
  const Scenario scenario = scenario_with(kUndecided);
  auto forecast = std::make_shared<controller::ObstacleForecast>(1);
  MovingObstacles obstacles(scenario.safe_set, 0.1, 3, forecast);
  int turned = 0;
  constexpr int kDrives = 2000;
  for (std::uint64_t seed = 0; seed < kDrives; ++seed) {
    std::uint64_t period = 0;
    const MovingObstacles::KeyOf key = [&](models::RandomStream stream) {
      return models::RandomKey{.seed = seed, .stream = stream, .step = period};
    };
    obstacles.begin(key);
    for (; period < 25; ++period) obstacles.advance({50.0, 50.0}, key);
    if (std::abs(obstacles.poses()(2, 0)) > 0.5) ++turned;
  }
  EXPECT_NEAR(turned, 0.5 * kDrives, 4.0 * std::sqrt(0.25 * kDrives));
}

// The drive knows the exact laws, so errors of the forecast follow the forecast: the squared
// Mahalanobis distance is χ² with two degrees of freedom.
TEST(MovingObstacles, move_to_where_they_were_forecast_as_often_as_predicted) {
  const Scenario scenario = scenario_with(kWalker);
  auto forecast = std::make_shared<controller::ObstacleForecast>(1);
  constexpr int kAhead = 8;
  MovingObstacles obstacles(scenario.safe_set, 0.1, kAhead, forecast);
  double sum = 0.0;
  int within = 0;
  constexpr int kDrives = 3000;
  for (std::uint64_t seed = 0; seed < kDrives; ++seed) {
    std::uint64_t period = 0;
    const MovingObstacles::KeyOf key = [&](models::RandomStream stream) {
      return models::RandomKey{.seed = seed, .stream = stream, .step = period};
    };
    obstacles.begin(key);
    obstacles.see(key);
    while (period < 6) {
      obstacles.advance({50.0, 50.0}, key);
      ++period;
      obstacles.see(key);
    }
    const controller::ObstaclePlace place = forecast->at(0, kAhead).front();
    for (int k = 0; k < kAhead; ++k, ++period) obstacles.advance({50.0, 50.0}, key);
    const Eigen::Vector2d off = obstacles.poses().col(0).head<2>() - place.offset;
    const double square = off.dot(place.covariance.inverse() * off);
    sum += square;
    if (square < 4.0) ++within;
  }
  EXPECT_NEAR(sum / kDrives, 2.0, 4.0 * 2.0 / std::sqrt(kDrives));
  EXPECT_NEAR(within / double{kDrives}, 1.0 - std::exp(-2.0), 4.0 * 0.35 / std::sqrt(kDrives));
}

TEST(MovingObstacles, wait_for_the_vehicle_where_they_yield) {
  const Scenario scenario = scenario_with(
      "{disc: {centre: [5, 0], radius: 0.3}, motion: {velocity: [-1, 0], yields: 2.05}}");
  auto forecast = std::make_shared<controller::ObstacleForecast>(1);
  MovingObstacles obstacles(scenario.safe_set, 0.1, 3, forecast);
  const MovingObstacles::KeyOf key = [](models::RandomStream stream) {
    return models::RandomKey{.stream = stream};
  };
  obstacles.begin(key);
  for (int k = 0; k < 100; ++k) obstacles.advance({0.0, 0.0}, key);
  EXPECT_NEAR(obstacles.poses()(0, 0), -3.0, 1e-9);
  obstacles.advance({-9.0, 0.0}, key);
  EXPECT_NEAR(obstacles.poses()(0, 0), -3.1, 1e-9);
  EXPECT_NEAR(obstacles.poses_at(0.25)(0, 0), -3.025, 1e-9);
}

TEST(MovingObstacles, decide_how_a_drive_ends) {
  // It approaches the car faster than the car can turn away.
  const Trace hit =
      run_episode(scenario_with("{disc: {centre: [4, 0], radius: 1}, motion: {velocity: [-8, 0]}}",
                                {"initial_state.covariance=[0, 0, 0]"}),
                  {.seed = 1});
  EXPECT_EQ(hit.outcome, Outcome::kCollision);
  EXPECT_LT(hit.steps.size(), 6U);
  const EpisodeView view(hit);
  EXPECT_LE(view.clearances()[view.clearances().size() - 1], 0.0);
  EXPECT_GT(view.clearances()[0], 0.5);
  // A standing obstacle is driven around, as is one that moves away.
  const Trace gone =
      run_episode(scenario_with("{disc: {centre: [4, 0], radius: 1}, motion: {velocity: [8, 0]}}",
                                {"initial_state.covariance=[0, 0, 0]"}),
                  {.seed = 1});
  EXPECT_EQ(gone.outcome, Outcome::kTimeout);
}

TEST(MovingObstacles, are_read_back_from_a_trace) {
  const testing::TemporaryFolder folder;
  const Trace trace = run_episode(crossing(), {.seed = 3});
  write_trace(folder / "episode.h5", trace);
  const Trace read = read_trace(folder / "episode.h5");
  ASSERT_EQ(read.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < read.steps.size(); ++k) {
    EXPECT_EQ(read.steps[k].obstacles, trace.steps[k].obstacles);
    EXPECT_EQ(read.steps[k].obstacles_seen, trace.steps[k].obstacles_seen);
  }
  EXPECT_EQ(read.final_obstacles, trace.final_obstacles);
  EXPECT_EQ(EpisodeView(read).clearances(), EpisodeView(trace).clearances());
  const controller::UnsafeSet unsafe(driven_safe_set(read));
  EXPECT_TRUE(unsafe.is_certain(4));
}

TEST(MovingObstacles, are_reported_to_every_controller) {
  const Scenario scenario = crossing();
  std::vector<double> widths;
  const ControllerObject watcher{.name = "watcher", .act = [&](const controller::Situation& now) {
                                   const auto& stages = now.obstacles->of(0);
                                   widths.push_back(stages.back().front().covariance.trace() -
                                                    stages.front().front().covariance.trace());
                                   EXPECT_EQ(now.obstacles->of(1).front().size(), 2U);
                                   return ControllerAnswer{.input = Eigen::VectorXd::Zero(1)};
                                 }};
  const Trace trace = run_episode(scenario, {.seed = 1}, watcher);
  EXPECT_EQ(widths.size(), trace.steps.size());
  EXPECT_THAT(widths, ::testing::Each(::testing::Gt(0.0)));
}

}  // namespace moving_obstacles_test
}  // namespace qsmpc::harness
