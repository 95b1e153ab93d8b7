#include "harness/video/episode_painter.hpp"

#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/video/straight_episode.hpp"

namespace qsmpc::harness {
namespace episode_painter_test {

const VideoLayout kSmall{.width = 640, .height = 360};

VideoLayout seen_by(const std::string& camera) {
  VideoLayout layout = kSmall;
  layout.camera = camera;
  return layout;
}

int red_pixels(const render::Image& image, int x_begin, int x_end) {
  int count = 0;
  for (int y = 40; y < image.height / 2; ++y) {
    for (int x = x_begin; x < x_end; ++x) {
      const render::Pixel pixel = render::pixel_at(image, {x + 0.5, y + 0.5});
      count += pixel.red > 180 && pixel.green < 70 && pixel.blue < 70 ? 1 : 0;
    }
  }
  return count;
}

TEST(episode_painter, two_threads_draw_the_same_pictures_whatever_came_before) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  for (const char* camera : {"chase", "split"}) {
    const EpisodePictures pictures(view, seen_by(camera));
    render::Image images[2];
    const auto draw = [&pictures](double before, render::Image& image) {
      EpisodePainter painter(pictures);
      painter.draw(before, image);
      painter.draw(0.37, image);
    };
    std::thread first(draw, 0.0, std::ref(images[0]));
    std::thread second(draw, 0.5, std::ref(images[1]));
    first.join();
    second.join();
    ASSERT_EQ(images[0].width, 640);
    EXPECT_TRUE(images[0].rgb == images[1].rgb) << camera;
  }
}

TEST(episode_painter, shows_two_episodes_side_by_side) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  const EpisodePictures pictures(view, kSmall, &view);
  EpisodePainter painter(pictures);
  render::Image image;
  painter.draw(0.3, image);
  EXPECT_GT(red_pixels(image, 0, 319), 50);
  EXPECT_GT(red_pixels(image, 321, 640), 50);
}

TEST(episode_painter, the_shorter_episode_stands_on_its_last_frame) {
  const Trace left = straight_trace();
  Trace right = straight_trace();
  right.steps.resize(3);
  right.final_state = state_at(3);
  const EpisodeView shown(left);
  const EpisodeView beside(right);
  const EpisodePictures pictures(shown, kSmall, &beside);
  EXPECT_DOUBLE_EQ(pictures.duration(), 0.6);
  const std::vector<render::Frame> frames = pictures.at(0.5);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].banner.empty());
  EXPECT_THAT(frames[1].banner, ::testing::HasSubstr("target reached after 0.3 s"));
  EXPECT_NEAR(frames[1].pose.x, 3 * kStride, 1e-12);
  // A common time axis and range.
  EXPECT_EQ(frames[0].charts[2].slots, frames[1].charts[2].slots);
  EXPECT_EQ(frames[0].charts[0].lower, frames[1].charts[0].lower);
}

TEST(episode_painter, headings_name_scenario_plant_and_policy) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  const EpisodePictures pictures(view, kSmall, &view);
  EXPECT_EQ(pictures.scenes().at(1).heading, "straight, analytic plant, closed loop");
  EXPECT_EQ(EpisodePictures(view, kSmall).scenes().at(0).heading, "");
}

TEST(episode_painter, refuses_unknown_cameras) {
  const Trace trace = straight_trace();
  const EpisodeView view(trace);
  const EpisodePictures pictures(view, seen_by("front"));
  EXPECT_THROW(EpisodePainter{pictures}, std::invalid_argument);
}

}  // namespace episode_painter_test
}  // namespace qsmpc::harness
