// Moving obstacles in the frames of an episode.
#include "harness/video/moving_bodies.hpp"

#include <cmath>
#include <cstddef>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/video/episode_frames.hpp"
#include "tests/unit/video/straight_episode.hpp"

namespace qsmpc::harness {
namespace moving_bodies_test {

using ::testing::ElementsAre;

constexpr double kSpeed = 2.0;   // m/s, along y
constexpr double kRadius = 0.2;  // m
const Eigen::Vector2d kBegin(0.9, -1.0);

/// It crosses the path of the straight episode.
Trace crossed_trace() {
  Trace trace = straight_trace();
  controller::Obstacle walker(controller::DiscShape{.centre = kBegin, .radius = kRadius});
  walker.motion = models::ObstacleMotion{
      .ways = {{.probability = 0.995, .onward = Eigen::Vector2d(0.0, kSpeed)},
               {.probability = 0.005, .onward = Eigen::Vector2d(kSpeed, 0.0)}},
      .speed_deviation = {0.3, 0.1},
      .memory = 1e3,
      .seen_deviation = 0.5};
  trace.scenario.safe_set.body = {.discs = {}, .x = 0, .y = 1};
  trace.scenario.safe_set.obstacles = {walker};
  for (StepRecord& step : trace.steps) {
    step.obstacles = Eigen::Vector3d(0.0, kSpeed * step.time, 0.0);
    step.obstacles_seen = step.obstacles.topRows<2>();
  }
  trace.final_obstacles = Eigen::Vector3d(0.0, kSpeed * kPeriod * kSteps, 0.0);
  return trace;
}

render::PlanarPoint middle_of(const render::Prism& prism) {
  render::PlanarPoint middle;
  for (const render::PlanarPoint& corner : prism.outline) {
    middle.x += corner.x / static_cast<double>(prism.outline.size());
    middle.y += corner.y / static_cast<double>(prism.outline.size());
  }
  return middle;
}

TEST(moving_bodies, are_where_they_truly_are_and_not_where_they_are_written) {
  const Trace trace = crossed_trace();
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  EXPECT_TRUE(frames.world().prisms.empty());
  for (const double time : {0.0, 0.13, 0.6}) {
    const render::Frame frame = frames.at(time);
    ASSERT_EQ(frame.moving.size(), 1U);
    const render::PlanarPoint middle = middle_of(frame.moving.front());
    EXPECT_NEAR(middle.x, kBegin.x(), 1e-9);
    EXPECT_NEAR(middle.y, kBegin.y() + kSpeed * time, 1e-9);
  }
}

// Each place on the path already driven keeps the clearance of the time when it was passed.
TEST(moving_bodies, count_for_the_clearance_of_the_way_when_it_was_driven) {
  const Trace trace = crossed_trace();
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  const auto clearance = [&](const render::PlanarPoint& place, double time) {
    const double wall = std::min(place.y + 1.0, place.x + 1.0);
    const double y = kBegin.y() + kSpeed * time;
    return std::min(wall, std::hypot(place.x - kBegin.x(), place.y - y) - kRadius);
  };
  const render::Frame now = frames.at(0.42);
  ASSERT_EQ(now.clearances.size(), now.driven_path.size());
  EXPECT_NEAR(now.clearances.back(), clearance(now.driven_path.back(), 0.42), 1e-9);
  EXPECT_NEAR(now.clearances.front(), clearance(now.driven_path.front(), 0.0), 1e-9);
  const render::Frame end = frames.at(0.6);
  for (std::size_t i = 0; i + 1 < now.clearances.size(); ++i) {
    EXPECT_EQ(end.clearances[i], now.clearances[i]) << i;
  }
  // When it crosses, it is nearer than the walls.
  EXPECT_LT(now.clearances.back(), 0.5);
}

TEST(moving_bodies, have_the_ellipses_of_their_probable_ways_as_the_plan_has_them) {
  const Trace trace = crossed_trace();
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  const render::Frame frame = frames.at(0.25);
  ASSERT_EQ(frame.forecasts.size(), 1U);  // the other way is very improbable
  const render::ForecastWay& way = frame.forecasts.front();
  EXPECT_GT(way.weight, 0.99);
  ASSERT_EQ(way.ellipses.size(), way.way.size());
  EXPECT_EQ(way.way.size(), 5U);
  // The observations fit the way exactly; the plan starts at 0.2 s.
  const double seconds = kPeriod * view.parts().stages;
  EXPECT_NEAR(way.way.front().y, kBegin.y() + kSpeed * 0.2, 1e-9);
  EXPECT_NEAR(way.way.back().y, kBegin.y() + kSpeed * (0.2 + seconds), 1e-9);
  const auto length = [](const render::PlanarPoint& axis) { return std::hypot(axis.x, axis.y); };
  EXPECT_GT(length(way.ellipses.back().first_axis), length(way.ellipses.front().first_axis));
  // Such measurements carry almost no information: the speed along the way deviates by 0.3 m/s.
  EXPECT_NEAR(length(way.ellipses.back().first_axis) / kForecastDeviations, 0.3 * (0.2 + seconds),
              0.2 * 0.3 * (0.2 + seconds));
}

TEST(moving_bodies, have_no_forecasts_without_a_plan_or_where_they_are_switched_off) {
  Trace trace = crossed_trace();
  trace.steps[2].plan_states.resize(3, 0);
  trace.steps[2].particles.clear();
  const EpisodeView view(trace);
  EXPECT_TRUE(EpisodeFrames(view).at(0.25).forecasts.empty());
  EXPECT_FALSE(EpisodeFrames(view).at(0.15).forecasts.empty());
  EXPECT_TRUE(EpisodeFrames(view, overlays_of({"path"})).at(0.15).forecasts.empty());
}

TEST(moving_bodies, do_not_enlarge_what_is_shown) {
  Trace trace = crossed_trace();
  trace.final_obstacles = Eigen::Vector3d(0.0, 500.0, 0.0);
  const EpisodeView view(trace);
  EXPECT_LT(EpisodeFrames(view).region().y_upper, 10.0);
}

}  // namespace moving_bodies_test
}  // namespace qsmpc::harness
