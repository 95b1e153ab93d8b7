#include "harness/video/episode_video.hpp"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/video/episode_frames.hpp"
#include "models/dynamics/dubins.hpp"
#include "tests/unit/render/decoded_video.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc {
namespace {

using testing::HasSubstr;

constexpr int kSteps = 6;
constexpr double kPeriod = 0.1;   // s
constexpr double kStride = 0.15;  // m driven in a period, along x
constexpr double kKick = 0.05;    // m, the disturbance along y after each period

Eigen::VectorXd state_at(int step) { return Eigen::Vector3d(kStride * step, kKick * step, 0.0); }

Scenario straight_scenario() {
  Scenario scenario;
  scenario.name = "straight";
  scenario.model = {"dubins", {{"speed", 1.5}}};
  scenario.plant = {"analytic", kRedBox};
  scenario.time_step = kPeriod;
  scenario.safe_set = unbounded_safe_set(3);
  scenario.safe_set.bounds.lower << -1.0, -1.0, -HUGE_VAL;
  scenario.safe_set.bounds.upper << 3.0, 2.0, HUGE_VAL;
  scenario.target = {Eigen::Vector3d(2.0, 1.0, 0.0), 0.3};
  scenario.controller.input_lower = Eigen::VectorXd::Constant(1, -2.0);
  scenario.controller.input_upper = Eigen::VectorXd::Constant(1, 2.0);
  return scenario;
}

// Straight ahead, moved sideways after each period.
Trace straight_trace() {
  Trace trace;
  trace.scenario = straight_scenario();
  for (int k = 0; k < kSteps; ++k) {
    StepRecord step;
    step.time = kPeriod * k;
    step.state = state_at(k);
    step.input = Eigen::VectorXd::Constant(1, 0.1 * k);
    step.disturbance = Eigen::Vector3d(0.0, kKick, 0.0);
    step.plan_states = Eigen::MatrixXd::Zero(3, 3);
    for (int stage = 0; stage < 3; ++stage) {
      step.plan_states.col(stage) = state_at(k) + Eigen::Vector3d(kStride * stage, 0.0, 0.0);
      step.particles.push_back({StateBatch(step.plan_states.col(stage)), Eigen::VectorXd::Ones(1)});
    }
    step.certificates.resize(2);
    step.certificates[0].value = 1e-3 * (k + 1);
    step.certificates[1].value = 0.25;
    trace.steps.push_back(step);
  }
  trace.final_state = state_at(kSteps);
  trace.outcome = Outcome::kReached;
  return trace;
}

std::string row_of(const Frame& frame, const std::string& name) {
  for (const HudRow& row : frame.hud) {
    if (row.name == name) {
      return row.value;
    }
  }
  return "no row " + name;
}

constexpr EpisodeVideoOptions kSmallVideo{.width = 320, .height = 180, .fps = 10};

TEST(episode_frames, vehicle_drives_from_state_to_state_and_eases_the_disturbance) {
  const Trace trace = straight_trace();
  const EpisodeFrames frames(trace);
  // In the middle of the first period: half a stride, not yet kicked.
  EXPECT_NEAR(frames.at(0.05).pose.x, 0.5 * kStride, 1e-12);
  EXPECT_NEAR(frames.at(0.05).pose.y, 0.0, 1e-12);
  // At the control instant the kick has not been drawn; half of it is after half of the ease time.
  EXPECT_NEAR(frames.at(0.1).pose.y, 0.0, 1e-12);
  EXPECT_NEAR(frames.at(0.1 + 0.5 * EpisodeTrack::kEaseTime).pose.y, 0.5 * kKick, 1e-12);
  EXPECT_NEAR(frames.at(0.1 + EpisodeTrack::kEaseTime).pose.y, kKick, 1e-12);
  EXPECT_NEAR(frames.at(0.1 + EpisodeTrack::kEaseTime).pose.x,
              kStride * (1.0 + EpisodeTrack::kEaseTime / kPeriod), 1e-12);
}

TEST(episode_frames, camera_follows_smoothly_without_lag) {
  const Trace trace = straight_trace();
  const EpisodeFrames frames(trace);
  // The states lie on a line, which the smoothing must reproduce, at its ends too.
  for (const double time : {0.0, 0.13, 0.37, 0.6}) {
    const Frame frame = frames.at(time);
    ASSERT_TRUE(frame.followed);
    EXPECT_NEAR(frame.followed->x, kStride * time / kPeriod, 1e-9) << time;
    EXPECT_NEAR(frame.followed->y, kKick * time / kPeriod, 1e-9) << time;
  }
}

TEST(episode_frames, a_killed_episode_is_drawn_as_far_as_it_came) {
  Trace trace = straight_trace();
  trace.final_state.resize(0);
  const EpisodeFrames frames(trace);
  const Eigen::VectorXd& last = trace.steps.back().state;
  EXPECT_DOUBLE_EQ(frames.at(frames.duration()).pose.x, last[0]);
}

TEST(episode_frames, qpos_comes_from_the_recorded_motion) {
  Trace trace = straight_trace();
  trace.motion = {{0.0, {0.0, 0.0}},   {0.05, {1.0, 10.0}},
                  {0.1, {2.0, 20.0}},  {0.1, {2.5, 20.0}},  // the same instant after the kick
                  {0.12, {2.7, 22.0}}, {0.15, {3.0, 25.0}}};
  const EpisodeFrames frames(trace);
  EXPECT_THAT(frames.at(0.025).qpos, testing::ElementsAre(0.5, 5.0));
  EXPECT_THAT(frames.at(0.1).qpos, testing::ElementsAre(2.0, 20.0));
  EXPECT_THAT(frames.at(0.125).qpos, testing::ElementsAre(testing::DoubleNear(2.5, 1e-9),
                                                          testing::DoubleNear(22.5, 1e-9)));
  EXPECT_THAT(frames.at(9.0).qpos, testing::ElementsAre(3.0, 25.0));
}

TEST(episode_frames, plan_and_certificate_are_those_of_the_running_period) {
  const Trace trace = straight_trace();
  const EpisodeFrames frames(trace);
  const Frame frame = frames.at(0.2);  // the third period begins
  ASSERT_EQ(frame.planned_path.size(), 3U);
  EXPECT_DOUBLE_EQ(frame.planned_path[0].x, 2.0 * kStride);
  ASSERT_EQ(frame.particles.size(), 3U);
  EXPECT_DOUBLE_EQ(frame.particles[1].points[0].x, 3.0 * kStride);
  EXPECT_THAT(row_of(frame, "P(unsafe) next step"), HasSubstr("3.00e-03"));
  EXPECT_THAT(row_of(frame, "P(unsafe) whole plan"), HasSubstr("2.53e-01"));
  EXPECT_THAT(row_of(frame, "speed"), HasSubstr("1.50"));
  ASSERT_EQ(frame.charts.size(), 2U);
  EXPECT_THAT(frame.charts[0].values, testing::ElementsAre(0.0, 0.1, 0.2));
  EXPECT_EQ(frame.charts[1].values.size(), 3U);
  EXPECT_TRUE(frame.banner.empty());
  EXPECT_THAT(frames.at(0.6).banner, HasSubstr("target reached"));
}

TEST(episode_frames, world_is_the_safe_set_in_the_plane) {
  Trace trace = straight_trace();
  Box obstacle = unbounded_safe_set(3).bounds;
  obstacle.lower.head(2) << 1.0, 0.5;
  obstacle.upper.head(2) << 1.5, 0.8;
  trace.scenario.safe_set.obstacles.push_back(obstacle);
  const World world = EpisodeFrames(trace).world();
  EXPECT_EQ(world.bounds.x_upper, 3.0);
  EXPECT_EQ(world.bounds.y_lower, -1.0);
  ASSERT_EQ(world.obstacles.size(), 1U);
  EXPECT_EQ(world.obstacles[0].y_upper, 0.8);
  EXPECT_EQ(world.target.x, 2.0);
}

TEST(episode_frames, trace_without_steps_still_has_a_frame) {
  Trace trace;
  trace.scenario = straight_scenario();
  trace.outcome = Outcome::kInterrupted;
  const EpisodeFrames frames(trace);
  EXPECT_EQ(frames.duration(), 0.0);
  EXPECT_EQ(frames.at(0.0).banner, "interrupted");
}

TEST(episode_video, lasts_as_long_as_the_episode_and_a_second_more) {
  const std::string path = fresh_folder() / "episode.mp4";
  int calls = 0;
  write_episode_video(straight_trace(), kSmallVideo, path, [&](int done, int total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 16);
    return true;
  });
  const DecodedVideo video = decode_video(path);
  EXPECT_EQ(video.frames, 16);  // 0.6 s and 1 s at 10 frames a second
  EXPECT_NEAR(video.duration, 1.6, 1e-3);
  EXPECT_EQ(video.width, 320);
}

TEST(episode_video, does_not_depend_on_the_number_of_threads) {
  const auto folder = fresh_folder();
  EpisodeVideoOptions options = kSmallVideo;
  for (const int threads : {1, 3}) {
    options.threads = threads;
    write_episode_video(straight_trace(), options, folder / (std::to_string(threads) + ".mp4"));
  }
  const DecodedVideo one = decode_video(folder / "1.mp4");
  const DecodedVideo three = decode_video(folder / "3.mp4");
  EXPECT_EQ(one.frames, three.frames);
  EXPECT_EQ(one.first.rgb, three.first.rgb);
}

TEST(episode_video, speed_shortens_the_episode_and_not_the_second_of_its_outcome) {
  const std::string path = fresh_folder() / "episode.mp4";
  EpisodeVideoOptions options = kSmallVideo;
  options.speed = 2.0;
  const VideoTimings timings = write_episode_video(straight_trace(), options, path);
  EXPECT_EQ(timings.frames, 13);  // 0.3 s and 1 s at 10 frames a second
  EXPECT_EQ(decode_video(path).frames, 13);
}

TEST(episode_video, part_of_an_episode_has_the_length_of_the_part) {
  const auto folder = fresh_folder();
  EpisodeVideoOptions options = kSmallVideo;
  options.from = 0.2;
  options.to = 0.5;
  write_episode_video(straight_trace(), options, folder / "part.mp4");
  EXPECT_EQ(decode_video(folder / "part.mp4").frames, 3);  // no outcome is shown
  // It begins where the whole one is then.
  write_episode_still(straight_trace(), options, 0.2, folder / "still.png");
  const Image begin = decode_video(folder / "part.mp4").first;
  const Image still = decode_video(folder / "still.png").first;
  double difference = 0.0;
  for (std::size_t i = 0; i < still.rgb.size(); ++i) {
    difference += std::abs(begin.rgb[i] - still.rgb[i]);
  }
  EXPECT_LT(difference / static_cast<double>(still.rgb.size()), 4.0);  // of 255, lossy coding
}

TEST(episode_video, speeds_and_times_that_are_none_are_refused_and_leave_no_file) {
  const auto folder = fresh_folder();
  const auto refused = [&](double speed, double from, double to) {
    EpisodeVideoOptions options = kSmallVideo;
    options.speed = speed;
    options.from = from;
    options.to = to;
    EXPECT_THROW(write_episode_video(straight_trace(), options, folder / "episode.mp4"),
                 std::invalid_argument)
        << speed << " " << from << " " << to;
  };
  refused(0.05, 0.0, 1.0);
  refused(101.0, 0.0, 1.0);
  refused(std::nan(""), 0.0, 1.0);
  refused(1.0, -0.1, 1.0);
  refused(1.0, 0.4, 0.3);
  refused(1.0, 0.7, 9.0);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(episode_video, every_format_shows_the_whole_episode) {
  const auto folder = fresh_folder();
  for (const std::string name : {"webm", "gif"}) {
    const std::string path = folder / ("episode." + name);
    write_episode_video(straight_trace(), kSmallVideo, path);
    const DecodedVideo video = decode_video(path);
    EXPECT_EQ(video.frames, 16) << name;
    EXPECT_NEAR(video.duration, 1.6, 0.02) << name;
    EXPECT_EQ(video.width, 320) << name;
  }
}

TEST(episode_video, timings_say_what_was_made_and_what_it_cost) {
  Trace trace = straight_trace();
  for (StepRecord& step : trace.steps) {
    step.timing.simulate = 2.5;
  }
  const VideoTimings timings =
      write_episode_video(trace, kSmallVideo, fresh_folder() / "episode.mp4");
  EXPECT_EQ(timings.frames, 16);
  EXPECT_EQ(timings.codec, "h264");
  EXPECT_EQ(timings.width, 320);
  EXPECT_DOUBLE_EQ(timings.seconds(), 1.6);
  EXPECT_DOUBLE_EQ(timings.simulation_ms, 2.5);
  EXPECT_GT(timings.drawing_ms, 0.0);
  EXPECT_GT(timings.encoding_ms, 0.0);
  EXPECT_NEAR(timings.frames_per_second(), 16 / timings.wall_s, 1e-9);
  for (const char* key : {"\"frames\": 16", "\"fps\": 10", "\"height\": 180", "\"codec\": \"h264\"",
                          "\"seconds\": 1.6", "\"simulation_ms\": 2.5", "\"drawing_ms\": "}) {
    EXPECT_THAT(video_json(timings), HasSubstr(key));
  }
  EXPECT_THAT(video_line(timings), HasSubstr("video: 16 frames in "));
}

TEST(episode_video, stopping_early_keeps_what_is_done) {
  const std::string path = fresh_folder() / "episode.mp4";
  write_episode_video(straight_trace(), kSmallVideo, path,
                      [](int done, int /*total*/) { return done < 5; });
  EXPECT_EQ(decode_video(path).frames, 5);
}

TEST(episode_video, vehicle_that_cannot_be_loaded_ends_it_without_a_video) {
  const std::string path = fresh_folder() / "episode.mp4";
  Trace trace = straight_trace();
  trace.scenario.plant.mjcf = "/nonexistent/car.xml";
  EXPECT_THROW(write_episode_video(trace, kSmallVideo, path), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(episode_video, what_cannot_be_drawn_is_said_instead) {
  const std::string path = ::testing::TempDir() + "nothing.mp4";
  const auto message_of = [&path](const Scenario& scenario) -> std::string {
    Trace trace;
    trace.scenario = scenario;
    try {
      write_episode_video(trace, kSmallVideo, path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing was refused";
  };
  Scenario scenario = straight_scenario();
  EXPECT_EQ(why_not_drawn(scenario), "");
  scenario.plant.mjcf = "";
  EXPECT_THAT(message_of(scenario), HasSubstr("names no vehicle"));
  scenario.model = {"double_integrator", {}};
  EXPECT_THAT(message_of(scenario), HasSubstr("double_integrator has no position in the plane"));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(episode_video, motion_of_another_vehicle_is_refused) {
  const std::string path = fresh_folder() / "episode.mp4";
  Trace trace = straight_trace();
  trace.motion = {{0.0, {1.0, 2.0}}, {0.6, {1.0, 2.0}}};
  EXPECT_THROW(write_episode_video(trace, kSmallVideo, path), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(episode_video, still_is_a_picture_of_the_size_asked_for) {
  const std::string path = fresh_folder() / "still.png";
  write_episode_still(straight_trace(), kSmallVideo, 0.3, path);
  const DecodedVideo still = decode_video(path);
  EXPECT_EQ(still.width, 320);
  EXPECT_EQ(still.height, 180);
}

}  // namespace
}  // namespace qsmpc
