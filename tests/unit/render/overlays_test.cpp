// A plan's belief in the picture: ellipses, tube, raw points, ghost, clearance; and panes.
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/palette.hpp"
#include "render/picture_layout.hpp"
#include "render/scene/belief_painter.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace overlays_test {

// Thin lines and translucent surfaces mix with the colours below them.
constexpr int kMixedColour = 90;
constexpr double kMarks = kMarkHeight;  // m

RenderOptions large_picture(const std::string& camera) { return {.camera = camera, .region = {}}; }

bool is_red(const Pixel& pixel) { return pixel.red > 180 && pixel.green < 70 && pixel.blue < 70; }

BeliefEllipses ellipses_at(double x, double y) {
  return {.half = {{x, y}, {0.3, 0.0}, {0.0, 0.2}}, .most = {{x, y}, {0.8, 0.2}, {-0.1, 0.4}}};
}

// The pixel among `place` and its neighbours that is closest to `colour`, since lines are thin.
Pixel nearest_pixel(const Image& image, const PixelPoint& place, const Colour& colour) {
  Pixel nearest = pixel_at(image, place);
  for (const double dx : {-1.0, 0.0, 1.0}) {
    for (const double dy : {-1.0, 0.0, 1.0}) {
      const Pixel pixel = pixel_at(image, {place.x + dx, place.y + dy});
      if (colour_difference(pixel, colour) < colour_difference(nearest, colour)) nearest = pixel;
    }
  }
  return nearest;
}

/// The contrast of the forecast's colour at the rightmost point of the last of two ellipses.
int forecast_contrast(double weight) {
  Renderer renderer(large_picture("top"), small_world(), kRedBox);
  Frame frame;
  Image image;
  renderer.draw(frame, image);
  const PlanarEllipse first{{-1.5, 0.0}, {0.3, 0.0}, {0.0, 0.3}};
  const PlanarEllipse last{{1.5, 0.0}, {0.6, 0.0}, {0.0, 0.6}};
  const auto at_side = [&](const PlanarEllipse& ellipse) {
    const PlanarPoint side = on_ellipse(ellipse, 0.0);
    return nearest_pixel(image, *renderer.locate(frame, side, kMarks), palette::kForecast);
  };
  const Pixel before = at_side(last);
  frame.forecasts = {
      {.weight = weight, .way = {{-1.5, 0.0}, {1.5, 0.0}}, .ellipses = {first, last}}};
  renderer.draw(frame, image);
  EXPECT_LT(at_side(first).red, before.red - 20);
  EXPECT_LT(at_side(last).red, at_side(last).blue);
  return before.red - at_side(last).red;
}

TEST(overlays, forecasts_are_fainter_the_later_and_the_less_probable) {
  const int certain = forecast_contrast(1.0);
  const int improbable = forecast_contrast(0.1);
  EXPECT_GT(certain, improbable + 10);
  EXPECT_GT(improbable, 5);  // still visible
}

TEST(overlays, ellipses_are_drawn_in_their_stages_colour) {
  Renderer renderer(large_picture("top"), small_world(), kRedBox);
  Frame frame;
  frame.ellipses = {ellipses_at(-1.5, 0.0), ellipses_at(1.5, 0.0)};
  Image image;
  renderer.draw(frame, image);
  for (int stage = 0; stage < 2; ++stage) {
    for (const PlanarEllipse& ellipse : {frame.ellipses[static_cast<std::size_t>(stage)].half,
                                         frame.ellipses[static_cast<std::size_t>(stage)].most}) {
      for (int i = 0; i < 8; ++i) {
        const PlanarPoint point = on_ellipse(ellipse, 2.0 * std::numbers::pi * i / 8);
        const Pixel pixel =
            nearest_pixel(image, *renderer.locate(frame, point, kMarks), stage_colour(stage, 2));
        EXPECT_LT(colour_difference(pixel, stage_colour(stage, 2)), 110) << stage << " at " << i;
        EXPECT_GT(colour_difference(pixel, palette::kSafeGround), 60) << stage << " at " << i;
      }
    }
    const Pixel between =
        pixel_at(image, *renderer.locate(frame, {stage == 0 ? -1.5 : 1.5, 0.0}, kMarks));
    EXPECT_LT(colour_difference(between, palette::kSafeGround), 40) << stage;
  }
}

TEST(overlays, tube_has_the_colour_of_its_stages_bound) {
  Renderer renderer(large_picture("top"), small_world(), kRedBox);
  Frame frame;
  frame.pose = {-2.0, 2.0, 0.0};
  for (const double bound : {1e-7, 1e-7, 1.0, 1.0}) {
    const double x = -1.5 + static_cast<double>(frame.tube.size());
    frame.tube.push_back({{x, 0.4}, {x, -0.4}, bound});
  }
  Image image;
  renderer.draw(frame, image);
  const auto expected = [](double bound) {
    return mix(palette::kSafeGround, risk_colour(bound), palette::kTubeOpacity);
  };
  const Pixel calm = pixel_at(image, *renderer.locate(frame, {-0.9, 0.2}, kMarks));
  const Pixel risky = pixel_at(image, *renderer.locate(frame, {1.1, 0.2}, kMarks));
  EXPECT_LT(colour_difference(calm, expected(1e-7)), 12);
  EXPECT_LT(colour_difference(risky, expected(1.0)), 12);
  const Pixel beside = pixel_at(image, *renderer.locate(frame, {1.1, 0.7}, kMarks));
  EXPECT_LT(colour_difference(beside, palette::kSafeGround), 12);
}

TEST(overlays, ghost_stands_where_its_pose_projects_and_the_vehicle_where_it_was) {
  for (const char* camera : {"chase", "top", "fixed"}) {
    Renderer renderer(small_picture(camera), small_world(), kRedBox);
    Frame frame;
    frame.ghost = PlanarPose{0.9, 0.5, 0.3};
    Image image;
    renderer.draw(frame, image);
    const Pixel ghost = pixel_at(image, *renderer.locate(frame, {0.9, 0.5}, 0.2));
    EXPECT_LT(
        colour_difference(ghost, mix(palette::kSafeGround, palette::kGhost, palette::kGhost.alpha)),
        kMixedColour)
        << camera;
    EXPECT_GT(ghost.blue, ghost.red + 40) << camera;
    EXPECT_TRUE(is_red(pixel_at(image, *renderer.locate(frame, {0.0, 0.0}, 0.2)))) << camera;
  }
}

TEST(overlays, obstacle_in_front_hides_ghost_and_tube) {
  World world = small_world();
  world.obstacles = {{0.6, 1.0, -0.6, 0.6}};
  Renderer renderer(small_picture("chase"), world, kRedBox);
  Frame plain;
  Frame frame;
  frame.ghost = PlanarPose{1.35, 0.0, 0.0};
  frame.tube = {{{1.1, 0.1}, {1.1, -0.1}, 1.0}, {{1.4, 0.1}, {1.4, -0.1}, 1.0}};
  Image with;
  Image without;
  renderer.draw(frame, with);
  renderer.draw(plain, without);
  const auto place = renderer.locate(frame, {1.2, 0.0}, 0.0);
  EXPECT_EQ(pixel_at(with, *place).red, pixel_at(without, *place).red);
  EXPECT_EQ(pixel_at(with, *place).blue, pixel_at(without, *place).blue);
}

TEST(overlays, driven_path_has_the_colour_of_its_clearance) {
  Renderer renderer(large_picture("top"), small_world(), kRedBox);
  Frame frame;
  frame.pose = {-2.0, 2.0, 0.0};
  frame.driven_path = {{-1.0, 0.0}, {0.0, 0.0}, {0.5, 0.0}, {1.5, 0.0}};
  frame.clearances = {0.0, 0.0, 5.0, 5.0};
  Image image;
  renderer.draw(frame, image);
  const auto colour_at = [&](double x) {
    return pixel_at(image, *renderer.locate(frame, {x, 0.0}, kMarks));
  };
  EXPECT_LT(colour_difference(colour_at(-0.5), clearance_colour(0.0)), kMixedColour);
  EXPECT_LT(colour_difference(colour_at(1.0), clearance_colour(5.0)), kMixedColour);
}

TEST(overlays, what_is_unsafe_is_striped) {
  World world = small_world();
  world.obstacles = {{0.5, 2.0, 0.5, 2.0}};
  Renderer renderer(large_picture("top"), world, kRedBox);
  Image image;
  renderer.draw(Frame{}, image);
  int striped = 0;
  for (double x = 0.6; x < 1.9; x += 0.01) {
    const Pixel pixel = pixel_at(image, *renderer.locate(Frame{}, {x, 1.2}, 0.4));
    striped += pixel.red > pixel.blue + 20 ? 1 : 0;
  }
  EXPECT_GT(striped, 5);
  EXPECT_LT(striped, 90);
}

TEST(panes, of_split_show_the_vehicle_where_it_projects_in_each) {
  Renderer renderer(small_picture("split"), small_world(), kRedBox);
  Frame frame;
  frame.pose = {0.4, -0.5, 0.7};
  frame.title = "two panes";
  Image image;
  renderer.draw(frame, image);
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 360);
  const auto chase = renderer.locate(frame, {0.4, -0.5}, 0.2, 0);
  const auto top = renderer.locate(frame, {0.4, -0.5}, 0.2, 1);
  ASSERT_TRUE(chase && top);
  EXPECT_LT(chase->x, 320);
  EXPECT_GT(top->x, 320);
  EXPECT_TRUE(is_red(pixel_at(image, *chase)));
  EXPECT_TRUE(is_red(pixel_at(image, *top)));
}

TEST(panes, of_two_episodes_each_show_their_own_frame) {
  const EpisodeScene scene{.world = small_world(), .mjcf_path = kRedBox};
  Renderer renderer({.width = 640, .height = 360, .camera = "split"}, {scene, scene});
  std::vector<Frame> frames(2);
  frames[0].pose = {0.5, 0.5, 0.0};
  frames[1].pose = {-1.0, -1.0, 0.0};
  Image image;
  renderer.draw(frames, image);
  for (std::size_t pane = 0; pane < 4; ++pane) {  // chase and top, left; chase and top, right
    const Frame& frame = frames[pane / 2];
    const auto place = renderer.locate(frame, {frame.pose.x, frame.pose.y}, 0.2, pane);
    ASSERT_TRUE(place);
    EXPECT_EQ(place->x > 320, pane >= 2) << pane;
    EXPECT_TRUE(is_red(pixel_at(image, *place))) << pane;
  }
  EXPECT_THROW(renderer.draw(frames[0], image), std::invalid_argument);
}

TEST(panes, cover_the_picture_without_overlapping) {
  for (const std::size_t episodes : {1U, 2U}) {
    for (const char* camera : {"chase", "split"}) {
      const PictureLayout layout =
          picture_layout(641, 361, camera, episodes, {.charts = 90.0, .legend = 30.0});
      for (const PaneLayout& a : layout.panes) {
        EXPECT_LE(a.x + a.width, 641);
        EXPECT_LE(a.y + a.height, 361);
        for (const PaneLayout& b : layout.panes) {
          const bool apart = a.x + a.width <= b.x || b.x + b.width <= a.x ||
                             a.y + a.height <= b.y || b.y + b.height <= a.y;
          EXPECT_TRUE(&a == &b || apart);
        }
      }
      EXPECT_EQ(layout.panes.size(), episodes * (std::string(camera) == "split" ? 2U : 1U));
    }
  }
  EXPECT_THROW((void)picture_layout(64, 64, "split", 2, {.charts = 90.0, .legend = 30.0}),
               std::invalid_argument);
}

TEST(colours, of_risk_get_darker_and_are_the_same_beyond_their_ends) {
  const auto luma = [](const Colour& c) {
    return 0.21F * c.red + 0.72F * c.green + 0.07F * c.blue;
  };
  for (double bound = 1e-6; bound < 0.9; bound *= 3.0) {
    EXPECT_GT(luma(risk_colour(bound)), luma(risk_colour(3.0 * bound))) << bound;
  }
  EXPECT_EQ(luma(risk_colour(0.0)), luma(risk_colour(1e-6)));
  EXPECT_EQ(luma(risk_colour(std::nan(""))), luma(risk_colour(1.0)));
}

// "#rrggbb"
std::string hex(const Colour& colour) {
  const auto byte = [](float value) { return static_cast<int>(std::lround(255.0F * value)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green),
                     byte(colour.blue));
}

TEST(colours, of_stages_and_clearance_are_the_same_on_pages) {
  std::ifstream file(std::string(QSMPC_SOURCE_DIR) + "/harness/report/web/map.js");
  const std::string script{std::istreambuf_iterator<char>(file), {}};
  const auto palette = [&script](const std::string& name) {
    const std::size_t begin = script.find(name + " = [");
    std::string list = script.substr(begin, script.find(']', begin) - begin);
    std::erase_if(list, [](char c) { return c == '\n' || c == ' ' || c == '"'; });
    return list.substr(list.find('[') + 1);
  };
  std::vector<std::string> stages;
  for (int stage = 0; stage < 11; ++stage) stages.push_back(hex(stage_colour(stage, 11)));
  EXPECT_EQ(palette("kStageColours"), fmt::format("{}", fmt::join(stages, ",")));
  std::vector<std::string> clearances;
  for (const double share : {0.0, 0.5, 1.0}) {
    clearances.push_back(hex(clearance_colour(share * kCalmClearance)));
  }
  EXPECT_EQ(palette("kClearanceColours"), fmt::format("{}", fmt::join(clearances, ",")));
}

}  // namespace overlays_test
}  // namespace qsmpc::render
