// Frames of systems without a position in the plane.

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "harness/scenario/scenario_file.hpp"
#include "harness/video/episode_frames.hpp"
#include "harness/video/episode_painter.hpp"
#include "tests/support/described_trace.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::harness {
namespace rail_frames_test {

// A point on a line that advances by 0.1 m per period, and its plan, which continues the motion.
Trace rail_trace() {
  Trace trace;
  trace.scenario = load_scenario("double_integrator");
  for (int k = 0; k < 4; ++k) {
    StepRecord step;
    step.time = 0.1 * k;
    step.state = Eigen::Vector2d(0.1 * k, 1.0);
    step.input = Eigen::VectorXd::Zero(1);
    step.disturbance = Eigen::Vector2d::Zero();
    step.plan_states = Eigen::MatrixXd::Ones(2, 3);
    for (int stage = 0; stage < 3; ++stage) {
      step.plan_states(0, stage) = 0.1 * (k + stage);
      step.particles.push_back(
          {models::StateBatch(step.plan_states.col(stage)), Eigen::VectorXd::Ones(1)});
    }
    trace.steps.push_back(step);
  }
  trace.final_state = Eigen::Vector2d(0.4, 1.0);
  trace.outcome = Outcome::kReached;
  return testing::described(std::move(trace));
}

TEST(RailFrames, a_system_without_a_plane_stands_on_a_rail_and_time_is_y) {
  const Trace trace = rail_trace();
  const EpisodeView view(trace);
  EXPECT_EQ(why_not_drawn(view), "");
  const EpisodeFrames frames(view);
  const render::Frame frame = frames.at(0.25);
  EXPECT_NEAR(frame.pose.x, 0.25, 1e-9);
  EXPECT_EQ(frame.pose.y, 0.0);
  ASSERT_EQ(frame.qpos.size(), 1U);  // the slider's joint
  EXPECT_NEAR(frame.qpos[0], 0.25, 1e-9);
  ASSERT_EQ(frame.particles.size(), 3U);  // of 0.2, 0.3 and 0.4 s
  EXPECT_NEAR(frame.particles[2].points[0].x, 0.4, 1e-9);
  EXPECT_NEAR(frame.particles[2].points[0].y, -0.15, 1e-9);
  EXPECT_NEAR(frame.planned_path[1].y, -0.05, 1e-9);
  EXPECT_NEAR(frame.driven_path.front().y, 0.25, 1e-9);
  EXPECT_NEAR(frame.driven_path.back().y, 0.0, 1e-9);
  EXPECT_EQ(frames.world().bounds.x_upper, 3.0);
  EXPECT_TRUE(std::isinf(frames.world().bounds.y_upper));
}

TEST(RailFrames, clearance_of_the_driven_path_is_that_of_the_whole_state) {
  Trace trace = rail_trace();
  // Faster than 1.2 m/s is unsafe, at any position.
  trace.scenario.safe_set.bounds.upper[1] = 1.2;
  trace.steps[2].state[1] = 1.1;
  const EpisodeView view(trace);
  const render::Frame frame = EpisodeFrames(view).at(0.4);
  ASSERT_EQ(frame.clearances.size(), frame.driven_path.size());
  double least = frame.clearances.front();
  for (const double clearance : frame.clearances) least = std::min(least, clearance);
  EXPECT_NEAR(frame.clearances.front(), 0.2, 1e-9);
  EXPECT_NEAR(least, 0.1, 1e-9);
  EXPECT_NEAR(frame.clearances.back(), 0.2, 1e-9);
}

/// The number of alarm-red pixels in the lines from `begin` on.
int red_pixels(const render::Image& image, int begin, int end) {
  int count = 0;
  for (int y = begin; y < end; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const render::Pixel pixel = render::pixel_at(image, {x + 0.5, y + 0.5});
      count += pixel.red > 180 && pixel.green < 70 && pixel.blue < 70 ? 1 : 0;
    }
  }
  return count;
}

TEST(RailFrames, the_outcome_does_not_hide_an_upright_pole) {
  Trace trace;
  trace.scenario = load_scenario("cart_pole_balance");
  for (int k = 0; k < 3; ++k) {
    StepRecord step;
    step.time = trace.scenario.time_step * k;
    step.state = Eigen::Vector4d::Zero();
    step.input = Eigen::VectorXd::Zero(1);
    step.disturbance = Eigen::Vector4d::Zero();
    trace.steps.push_back(step);
  }
  trace.final_state = Eigen::Vector4d::Zero();
  trace.outcome = Outcome::kCollision;  // with text on red
  trace = testing::described(std::move(trace));
  const EpisodeView view(trace);
  const EpisodePictures pictures(view, {.width = 640, .height = 360});
  EpisodePainter painter(pictures);
  render::Image image;
  painter.draw(pictures.duration(), image);
  EXPECT_EQ(red_pixels(image, 0, image.height / 2), 0);
  EXPECT_GT(red_pixels(image, image.height / 2, image.height), 500);
}

}  // namespace rail_frames_test
}  // namespace qsmpc::harness
