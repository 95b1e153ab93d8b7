#include "harness/video/episode_frames.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/video/belief_shape.hpp"
#include "harness/video/episode_hud.hpp"
#include "harness/video/episode_painter.hpp"
#include "render/scene/belief_painter.hpp"
#include "tests/unit/video/straight_episode.hpp"

namespace qsmpc::harness {
namespace episode_frames_test {

using ::testing::HasSubstr;

TEST(episode_frames, vehicle_drives_from_state_to_state_and_eases_the_disturbance) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  // In the middle of the first period: half a stride, before the kick.
  EXPECT_NEAR(frames.at(0.05).pose.x, 0.5 * kStride, 1e-12);
  EXPECT_NEAR(frames.at(0.05).pose.y, 0.0, 1e-12);
  // At the control instant the kick is not drawn yet; after half of the ease time, half of it is.
  EXPECT_NEAR(frames.at(0.1).pose.y, 0.0, 1e-12);
  EXPECT_NEAR(frames.at(0.1 + 0.5 * EpisodeTrack::kEaseTime).pose.y, 0.5 * kKick, 1e-12);
  EXPECT_NEAR(frames.at(0.1 + EpisodeTrack::kEaseTime).pose.y, kKick, 1e-12);
  EXPECT_NEAR(frames.at(0.1 + EpisodeTrack::kEaseTime).pose.x,
              kStride * (1.0 + EpisodeTrack::kEaseTime / kPeriod), 1e-12);
}

TEST(episode_frames, camera_follows_smoothly_without_lag) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  // The states lie on a line, which the smoothing must reproduce, including its ends.
  for (const double time : {0.0, 0.13, 0.37, 0.6}) {
    const render::Frame frame = frames.at(time);
    ASSERT_TRUE(frame.followed);
    EXPECT_NEAR(frame.followed->x, kStride * time / kPeriod, 1e-9) << time;
    EXPECT_NEAR(frame.followed->y, kKick * time / kPeriod, 1e-9) << time;
  }
}

TEST(episode_frames, a_killed_episode_is_drawn_as_far_as_it_came) {
  Trace trace = straight_trace();
  trace.final_state.resize(0);
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  const Eigen::VectorXd& last = trace.steps.back().state;
  EXPECT_DOUBLE_EQ(frames.at(frames.duration()).pose.x, last[0]);
}

TEST(episode_frames, qpos_comes_from_the_recorded_motion) {
  Trace trace = straight_trace();
  trace.motion = {{0.0, {0.0, 0.0}},   {0.05, {1.0, 10.0}},
                  {0.1, {2.0, 20.0}},  {0.1, {2.5, 20.0}},  // the same instant after the kick
                  {0.12, {2.7, 22.0}}, {0.15, {3.0, 25.0}}};
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  EXPECT_THAT(frames.at(0.025).qpos, ::testing::ElementsAre(0.5, 5.0));
  EXPECT_THAT(frames.at(0.1).qpos, ::testing::ElementsAre(2.0, 20.0));
  EXPECT_THAT(frames.at(0.125).qpos, ::testing::ElementsAre(::testing::DoubleNear(2.5, 1e-9),
                                                            ::testing::DoubleNear(22.5, 1e-9)));
  EXPECT_THAT(frames.at(9.0).qpos, ::testing::ElementsAre(3.0, 25.0));
}

TEST(episode_frames, plan_and_certificate_are_those_of_the_running_period) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  const render::Frame frame = frames.at(0.2);  // the third period begins
  ASSERT_EQ(frame.charts.size(), 4U);
  ASSERT_EQ(frame.planned_path.size(), 3U);
  EXPECT_DOUBLE_EQ(frame.planned_path[0].x, 2.0 * kStride);
  ASSERT_EQ(frame.particles.size(), 3U);
  EXPECT_DOUBLE_EQ(frame.particles[1].points[0].x, 3.0 * kStride);
  EXPECT_EQ(frame.charts[0].value, "≤ 0.3 %");
  EXPECT_EQ(row_of(frame, "risk of plan"), "≤ 26 %");  // 0.003 + 0.25, rounded up
  EXPECT_THAT(row_of(frame, "speed"), HasSubstr("1.50"));
  EXPECT_THAT(frame.charts[1].values, ::testing::ElementsAre(0.0, 0.1, 0.2));
  EXPECT_EQ(frame.charts[0].values.size(), 3U);
  EXPECT_TRUE(frame.banner.empty());
  EXPECT_THAT(frames.at(0.6).banner, HasSubstr("target reached"));
}

TEST(episode_frames, world_is_the_safe_set_in_the_plane) {
  Trace trace = straight_trace();
  controller::Box obstacle = controller::unbounded_safe_set(3).bounds;
  obstacle.lower.head(2) << 1.0, 0.5;
  obstacle.upper.head(2) << 1.5, 0.8;
  trace.scenario.safe_set.obstacles.push_back(obstacle);
  const render::World world = EpisodeFrames(EpisodeView(trace)).world();
  EXPECT_EQ(world.bounds.x_upper, 3.0);
  EXPECT_EQ(world.bounds.y_lower, -1.0);
  ASSERT_EQ(world.obstacles.size(), 1U);
  EXPECT_EQ(world.obstacles[0].y_upper, 0.8);
  EXPECT_EQ(world.target.x, 2.0);
}

TEST(episode_frames, shapes_stand_in_the_world_with_their_convex_pieces) {
  Trace trace = straight_trace();
  Eigen::Matrix2Xd corner(2, 6);
  corner << 0.0, 2.0, 2.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.5, 1.5, 2.0, 2.0;
  using controller::PlanarShape;
  std::vector<controller::Obstacle>& obstacles = trace.scenario.safe_set.obstacles;
  trace.scenario.safe_set.body = {.discs = {}, .x = 0, .y = 1};
  obstacles.emplace_back(PlanarShape(controller::PolygonShape{corner}));
  obstacles.emplace_back(PlanarShape(controller::DiscShape{.centre = {1.5, -0.5}, .radius = 0.2}));
  obstacles.emplace_back(PlanarShape(controller::HalfPlaneShape{.normal = {2, 0}, .offset = 5}));
  const render::World world = EpisodeFrames(EpisodeView(trace)).world();
  EXPECT_TRUE(world.obstacles.empty());
  ASSERT_EQ(world.prisms.size(), 2U);
  EXPECT_EQ(world.prisms[0].outline.size(), 6U);
  EXPECT_EQ(world.prisms[0].pieces.size(), 2U);
  EXPECT_EQ(world.prisms[1].pieces.size(), 1U);
  for (const render::PlanarPoint& point : world.prisms[1].outline) {
    EXPECT_NEAR(std::hypot(point.x - 1.5, point.y + 0.5), 0.2, 0.001);
  }
  ASSERT_EQ(world.half_planes.size(), 1U);
  EXPECT_EQ(world.half_planes[0].normal.x, 2.0);
  EXPECT_EQ(world.half_planes[0].offset, 5.0);
}

TEST(episode_frames, the_ways_colours_are_of_the_distance_to_the_shapes_themselves) {
  Trace trace = straight_trace();
  trace.scenario.safe_set.body = {.discs = {}, .x = 0, .y = 1};
  trace.scenario.safe_set.obstacles.emplace_back(
      controller::PlanarShape(controller::DiscShape{.centre = {0.0, -0.6}, .radius = 0.25}));
  const EpisodeView view(trace);
  const render::Frame frame = EpisodeFrames(view).at(0.3);
  ASSERT_EQ(frame.clearances.size(), frame.driven_path.size());
  ASSERT_GT(frame.clearances.size(), 2U);
  for (std::size_t i = 0; i < frame.clearances.size(); ++i) {
    const render::PlanarPoint& point = frame.driven_path[i];
    const double to_disc = std::hypot(point.x, point.y + 0.6) - 0.25;
    EXPECT_NEAR(frame.clearances[i], std::min({to_disc, point.x + 1.0, point.y + 1.0}), 1e-9);
  }
}

TEST(episode_frames, trace_without_steps_still_has_a_frame) {
  Trace trace = straight_trace();
  trace.steps.clear();
  trace.final_state.resize(0);
  trace.outcome = Outcome::kInterrupted;
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  EXPECT_EQ(frames.duration(), 0.0);
  EXPECT_EQ(frames.at(0.0).banner, "interrupted");
}

// A cloud about each stage's mean with variances 0.01 along x and 0.04 along y.
Trace cloudy_trace() {
  Trace trace = straight_trace();
  trace.scenario.disturbance.covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  trace.scenario.controller.policy = "open_loop";
  trace.scenario.controller.quantisation.noise = 9;
  for (StepRecord& step : trace.steps) {
    step.plan_inputs = Eigen::MatrixXd::Zero(1, 2);
    for (StageParticles& stage : step.particles) {
      const Eigen::Vector3d mean = stage.locations.col(0);
      stage.locations.resize(3, 4);
      stage.locations << mean[0] - 0.1, mean[0] + 0.1, mean[0] - 0.1, mean[0] + 0.1, mean[1] - 0.2,
          mean[1] - 0.2, mean[1] + 0.2, mean[1] + 0.2, 0.0, 0.0, 0.0, 0.0;
      stage.weights = Eigen::VectorXd::Constant(4, 0.25);
    }
  }
  return trace;
}

TEST(episode_frames, ellipses_and_tube_are_those_of_the_particles_moments) {
  const Trace trace = cloudy_trace();
  const render::Frame frame = EpisodeFrames(EpisodeView(trace)).at(0.2);
  ASSERT_EQ(frame.ellipses.size(), 3U);
  const double radius = std::sqrt(-2.0 * std::log(0.05));  // 95 % of the standard Gaussian
  const render::PlanarEllipse& most = frame.ellipses[1].most;
  EXPECT_NEAR(most.centre.x, 3.0 * kStride, 1e-12);
  EXPECT_NEAR(std::abs(render::on_ellipse(most, 0.0).y - most.centre.y), 0.2 * radius, 1e-12);
  EXPECT_NEAR(std::abs(render::on_ellipse(most, 0.5 * std::numbers::pi).x - most.centre.x),
              0.1 * radius, 1e-12);
  EXPECT_NEAR(std::hypot(frame.ellipses[1].half.first_axis.x, frame.ellipses[1].half.first_axis.y),
              0.2 * std::sqrt(-2.0 * std::log(0.5)), 1e-12);
  // The plan runs along x: the tube is as wide as the ellipse is along y.
  ASSERT_EQ(frame.tube.size(), 3U + 2U * kTubeEndSections);
  const render::TubeSection& second = frame.tube[kTubeEndSections + 1];
  EXPECT_NEAR(second.left.y - second.right.y, 0.4 * radius, 1e-12);
  EXPECT_EQ(second.bound, 3e-3);
  EXPECT_EQ(frame.tube.back().bound, 0.25);
}

// Twice the triangle's signed area, positive for a left turn.
double turn(const render::PlanarPoint& a, const render::PlanarPoint& b,
            const render::PlanarPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

TEST(episode_frames, tube_ends_round_and_covers_the_last_ellipse) {
  std::vector<PlanarMoments> stages(2);
  stages[0].covariance = Eigen::Vector2d(0.01, 0.01).asDiagonal();
  stages[1].mean << 1.0, 0.4;
  stages[1].covariance << 0.09, 0.03, 0.03, 0.04;  // oblique to the path
  const std::vector<render::TubeSection> tube = belief_tube(stages, {0.1});
  std::vector<render::PlanarPoint> outline;  // along the left side of the path, and back
  for (auto at = tube.rbegin(); at != tube.rend(); ++at) outline.push_back(at->left);
  for (const render::TubeSection& section : tube) outline.push_back(section.right);
  const Eigen::Vector2d along = stages[1].mean.normalized();
  // Chords between the sections of the end cut off up to 2 % of the ellipse's radii.
  const PlanarMoments smaller{stages[1].mean, 0.95 * stages[1].covariance};
  const render::PlanarEllipse ellipse = probability_ellipse(smaller, 0.95);
  for (int i = 0; i < 64; ++i) {
    const render::PlanarPoint point = render::on_ellipse(ellipse, 2.0 * std::numbers::pi * i / 64);
    const double ahead = along.dot(Eigen::Vector2d(point.x, point.y) - stages[1].mean);
    if (ahead < 0.0) continue;  // that half lies within the band
    for (std::size_t k = 1; k < outline.size(); ++k) {
      const bool at_end =
          along.dot(Eigen::Vector2d(outline[k].x, outline[k].y) - stages[1].mean) > 0.2;
      if (at_end) {
        EXPECT_GE(turn(outline[k - 1], outline[k], point), -1e-9) << i << " at " << k;
      }
    }
  }
  EXPECT_NEAR(std::hypot(tube.back().left.x - tube.back().right.x,
                         tube.back().left.y - tube.back().right.y),
              0.0, 1e-9);  // the tip
}

TEST(episode_frames, ghost_drives_along_the_plan_of_the_period_before) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  const auto ghost = frames.at(0.25).ghost;
  ASSERT_TRUE(ghost);
  EXPECT_NEAR(ghost->x, 2.5 * kStride, 1e-12);
  EXPECT_NEAR(ghost->y, 1.0 * kKick, 1e-12);  // that plan did not know of the second kick
}

TEST(episode_frames, clearance_of_the_driven_path_is_the_distance_to_the_unsafe_set) {
  const Trace trace = straight_trace();
  const render::Frame frame = EpisodeFrames(EpisodeView(trace)).at(0.05);
  ASSERT_EQ(frame.clearances.size(), frame.driven_path.size());
  EXPECT_NEAR(frame.clearances.front(), 1.0, 1e-12);  // from the origin to the walls at -1
}

TEST(episode_frames, raw_points_are_the_stepped_ones_with_the_noise) {
  const Trace trace = cloudy_trace();
  Overlays overlays;
  overlays.raw = true;
  const render::Frame frame = EpisodeFrames(EpisodeView(trace), overlays).at(0.2);
  ASSERT_GT(frame.raw_points.size(), 2U * 4U);
  EXPECT_EQ(row_of(frame, "raw points drawn"), "all");
  render::PlanarPoint mean;
  for (std::size_t i = 0; i < frame.raw_points.size(); ++i) mean.x += frame.raw_points[i].x;
  // Both stages move 0.15 m ahead; noise and clouds are symmetric, with equal weight on both sides.
  EXPECT_NEAR(mean.x / static_cast<double>(frame.raw_points.size()), (3.0 + 4.0) / 2.0 * kStride,
              1e-9);
  EXPECT_TRUE(EpisodeFrames(EpisodeView(trace)).at(0.2).raw_points.empty());
}

TEST(episode_frames, too_many_particles_are_thinned_with_a_note_in_a_row) {
  Trace trace = straight_trace();
  constexpr Eigen::Index kMany = 7000;  // per stage, three stages
  for (StageParticles& stage : trace.steps[0].particles) {
    stage.locations = controller::Points::Random(3, kMany);
    stage.weights = Eigen::VectorXd::Constant(kMany, 1.0 / kMany);
  }
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  const render::Frame frame = frames.at(0.0);
  EXPECT_EQ(frame.particles[0].points.size(), 3500U);
  EXPECT_EQ(row_of(frame, "particles drawn"), "1 of 2");
  EXPECT_EQ(row_of(frames.at(0.2), "particles drawn"), "no row particles drawn");
}

TEST(episode_frames, overlays_can_be_switched_off) {
  const Trace trace = cloudy_trace();
  const render::Frame frame =
      EpisodeFrames(EpisodeView(trace), parse_overlays("none", "--overlays")).at(0.2);
  EXPECT_TRUE(frame.particles.empty() && frame.ellipses.empty() && frame.tube.empty());
  EXPECT_TRUE(frame.raw_points.empty() && frame.clearances.empty() && !frame.ghost);
  EXPECT_TRUE(frame.body.empty());
  EXPECT_FALSE(frame.planned_path.empty());
}

TEST(episode_frames, a_long_history_scrolls) {
  Trace trace = straight_trace();
  const StepRecord step = trace.steps.back();
  for (int k = kSteps; k < 300; ++k) {
    trace.steps.push_back(step);
    trace.steps.back().time = kPeriod * k;
  }
  const render::Frame frame = EpisodeFrames(EpisodeView(trace)).at(29.95);
  EXPECT_EQ(frame.charts[0].slots, 200U);  // 20 s
  EXPECT_EQ(frame.charts[0].values.size(), 200U);
}

TEST(episode_frames, body_is_outlined_where_the_vehicle_stands) {
  Trace trace = straight_trace();
  EXPECT_TRUE(EpisodeFrames(EpisodeView(trace)).at(0.05).body.empty());  // a point
  trace.scenario.safe_set.body = {
      .discs = {{.radius = 0.2, .offset = {0.1, 0.0}}, {.radius = 0.2, .offset = {0.3, 0.0}}},
      .x = 0,
      .y = 1,
      .heading = 2};
  const render::Frame frame = EpisodeFrames(EpisodeView(trace)).at(0.05);
  ASSERT_EQ(frame.body.size(), 2U);
  for (std::size_t disc = 0; disc < 2; ++disc) {
    for (const render::PlanarPoint& point : frame.body[disc]) {
      EXPECT_NEAR(std::hypot(point.x - frame.pose.x - 0.1 - 0.2 * static_cast<double>(disc),
                             point.y - frame.pose.y),
                  0.2, 1e-12);
    }
  }
}

TEST(overlays, lists_name_what_is_shown) {
  const Overlays some = parse_overlays("tube,raw", "--overlays");
  EXPECT_TRUE(some.tube && some.raw);
  EXPECT_FALSE(some.particles || some.ellipses || some.ghost || some.body || some.path);
  EXPECT_TRUE(parse_overlays("all", "--overlays").raw);
  for (const char* wrong : {"", "tube,", "tubes", "all,tube"}) {
    EXPECT_THROW((void)parse_overlays(wrong, "--overlays"), InputError) << wrong;
  }
  EXPECT_THROW((void)overlays_of({"x"}), std::invalid_argument);
  // A scenario's default equals the default of the values.
  const Overlays shipped = overlays_of(Scenario::Video{}.overlays);
  const Overlays plain;
  EXPECT_EQ(shipped.raw, plain.raw);
  EXPECT_TRUE(shipped.particles && shipped.ellipses && shipped.tube && shipped.ghost &&
              shipped.body && shipped.path);
}

}  // namespace episode_frames_test
}  // namespace qsmpc::harness
