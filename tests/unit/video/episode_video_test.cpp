#include "harness/video/episode_video.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/video/episode_painter.hpp"
#include "tests/unit/render/decoded_video.hpp"
#include "tests/unit/video/straight_episode.hpp"

namespace qsmpc::harness {
namespace episode_video_test {

using ::testing::HasSubstr;

const EpisodeVideoOptions kSmallVideo{.width = 320, .height = 180, .fps = 10};

TEST(episode_video, lasts_as_long_as_the_episode_and_a_second_more) {
  const std::string path = render::fresh_folder() / "episode.mp4";
  int calls = 0;
  write_episode_video(EpisodeView(straight_trace()), kSmallVideo, path, [&](int done, int total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 16);
    return true;
  });
  const render::DecodedVideo video = render::decode_video(path);
  EXPECT_EQ(video.frames, 16);  // 0.6 s plus 1 s at 10 frames per second
  EXPECT_NEAR(video.duration, 1.6, 1e-3);
  EXPECT_EQ(video.width, 320);
}

TEST(episode_video, does_not_depend_on_the_number_of_threads) {
  const auto folder = render::fresh_folder();
  EpisodeVideoOptions options = kSmallVideo;
  for (const int threads : {1, 3}) {
    options.threads = threads;
    write_episode_video(EpisodeView(straight_trace()), options,
                        folder / (std::to_string(threads) + ".mp4"));
  }
  const render::DecodedVideo one = render::decode_video(folder / "1.mp4");
  const render::DecodedVideo three = render::decode_video(folder / "3.mp4");
  EXPECT_EQ(one.frames, three.frames);
  // The pictures are identical to the last bit (episode_painter_test.cpp); the encoder's output is
  // not.
  ASSERT_EQ(one.first.rgb.size(), three.first.rgb.size());
  int difference = 0;
  for (std::size_t i = 0; i < one.first.rgb.size(); ++i) {
    difference = std::max(difference, std::abs(one.first.rgb[i] - three.first.rgb[i]));
  }
  EXPECT_LE(difference, 40);
}

TEST(episode_video, speed_shortens_the_episode_and_not_the_second_of_its_outcome) {
  const std::string path = render::fresh_folder() / "episode.mp4";
  EpisodeVideoOptions options = kSmallVideo;
  options.speed = 2.0;
  const VideoTimings timings = write_episode_video(EpisodeView(straight_trace()), options, path);
  EXPECT_EQ(timings.frames, 13);  // 0.3 s plus 1 s at 10 frames per second
  EXPECT_EQ(render::decode_video(path).frames, 13);
}

TEST(episode_video, part_of_an_episode_has_the_length_of_the_part) {
  const auto folder = render::fresh_folder();
  EpisodeVideoOptions options = kSmallVideo;
  options.from = 0.2;
  options.to = 0.5;
  write_episode_video(EpisodeView(straight_trace()), options, folder / "part.mp4");
  EXPECT_EQ(render::decode_video(folder / "part.mp4").frames, 3);  // no outcome is shown
  // It starts with the same picture as the whole video at that time.
  write_episode_still(EpisodeView(straight_trace()), options, 0.2, folder / "still.png");
  const render::Image begin = render::decode_video(folder / "part.mp4").first;
  const render::Image still = render::decode_video(folder / "still.png").first;
  double difference = 0.0;
  for (std::size_t i = 0; i < still.rgb.size(); ++i) {
    difference += std::abs(begin.rgb[i] - still.rgb[i]);
  }
  EXPECT_LT(difference / static_cast<double>(still.rgb.size()), 4.0);  // out of 255, lossy coding
}

TEST(episode_video, invalid_speeds_and_times_are_refused_and_leave_no_file) {
  const auto folder = render::fresh_folder();
  const auto refused = [&](double speed, double from, double to) {
    EpisodeVideoOptions options = kSmallVideo;
    options.speed = speed;
    options.from = from;
    options.to = to;
    EXPECT_THROW(
        write_episode_video(EpisodeView(straight_trace()), options, folder / "episode.mp4"),
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
  const auto folder = render::fresh_folder();
  for (const std::string name : {"webm", "gif"}) {
    const std::string path = folder / ("episode." + name);
    write_episode_video(EpisodeView(straight_trace()), kSmallVideo, path);
    const render::DecodedVideo video = render::decode_video(path);
    EXPECT_EQ(video.frames, 16) << name;
    EXPECT_NEAR(video.duration, 1.6, 0.02) << name;
    EXPECT_EQ(video.width, 320) << name;
  }
}

TEST(episode_video, timings_list_what_was_made_and_what_it_cost) {
  Trace trace = straight_trace();
  for (StepRecord& step : trace.steps) {
    step.timing.simulate = 2.5;
  }
  const VideoTimings timings =
      write_episode_video(EpisodeView(trace), kSmallVideo, render::fresh_folder() / "episode.mp4");
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
  const std::string path = render::fresh_folder() / "episode.mp4";
  write_episode_video(EpisodeView(straight_trace()), kSmallVideo, path,
                      [](int done, int /*total*/) { return done < 5; });
  EXPECT_EQ(render::decode_video(path).frames, 5);
}

TEST(episode_video, vehicle_that_cannot_be_loaded_ends_it_without_a_video) {
  const std::string path = render::fresh_folder() / "episode.mp4";
  Trace trace = straight_trace();
  trace.scenario.plant.mjcf = "/nonexistent/car.xml";
  EXPECT_THROW(write_episode_video(EpisodeView(trace), kSmallVideo, path), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(episode_video, what_cannot_be_drawn_is_named_instead) {
  const std::string path = ::testing::TempDir() + "nothing.mp4";
  const auto message_of = [&path](const Scenario& scenario) -> std::string {
    Trace trace;
    trace.scenario = scenario;
    trace = testing::described(std::move(trace));
    try {
      write_episode_video(EpisodeView(trace), kSmallVideo, path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing was refused";
  };
  EXPECT_EQ(why_not_drawn(EpisodeView(straight_trace())), "");
  Scenario scenario = straight_scenario();
  scenario.plant.mjcf = "";
  EXPECT_THAT(message_of(scenario), HasSubstr("names no vehicle"));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(episode_video, motion_of_another_vehicle_is_refused) {
  const std::string path = render::fresh_folder() / "episode.mp4";
  Trace trace = straight_trace();
  trace.motion = {{0.0, {1.0, 2.0}}, {0.6, {1.0, 2.0}}};
  EXPECT_THROW(write_episode_video(EpisodeView(trace), kSmallVideo, path), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(episode_video, still_is_a_picture_of_the_size_asked_for) {
  const std::string path = render::fresh_folder() / "still.png";
  write_episode_still(EpisodeView(straight_trace()), kSmallVideo, 0.3, path);
  const render::DecodedVideo still = render::decode_video(path);
  EXPECT_EQ(still.width, 320);
  EXPECT_EQ(still.height, 180);
}

}  // namespace episode_video_test
}  // namespace qsmpc::harness
