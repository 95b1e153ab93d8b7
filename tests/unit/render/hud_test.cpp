#include "render/hud/hud.hpp"

#include <gtest/gtest.h>

#include "render/hud/legend.hpp"
#include "render/hud/strip_chart.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace hud_test {

Image black_image(int width, int height) {
  return {width, height, std::vector<unsigned char>(static_cast<std::size_t>(3 * width * height))};
}

Frame talkative_frame() {
  Frame frame;
  frame.title = "a scenario";
  frame.hud = {{"time", "1.0 s"}, {"speed", "1.5 m/s"}};
  frame.charts.assign(5, {.label = "chart", .values = {0.2, 0.4}, .slots = 20});
  return frame;
}

void draw_chart(const StripChart& chart, const PixelRectangle& area, const HudStyle& style,
                Image& image) {
  Canvas canvas(image);
  draw_strip_chart(chart, area, {0.0F, 1.0F, 0.0F}, style, canvas);
}

TEST(strip_chart, limit_is_a_dashed_line_at_its_value) {
  const HudStyle style(1280, 720);
  StripChart chart{.label = "time", .values = {10.0, 20.0}, .slots = 50, .upper = 200.0};
  const PixelRectangle area{10.0, 10.0, 300.0, 110.0};
  Image with = black_image(320, 130);
  Image without = with;
  draw_chart(chart, area, style, without);
  chart.limit = {.value = 150.0, .label = "limit"};
  draw_chart(chart, area, style, with);
  const double y = chart_point(chart, area, style, 0, 150.0).y;
  EXPECT_LT(y, chart_point(chart, area, style, 0, 100.0).y);
  int bright = 0;
  int dark = 0;
  for (int x = 12; x < 180; ++x) {
    int light = 0;
    for (const int row : {-1, 0}) {
      const PixelPoint place{x + 0.5, y + row + 0.5};
      light = std::max(light, pixel_at(with, place).red - pixel_at(without, place).red);
    }
    bright += light > 60 ? 1 : 0;
    dark += light < 20 ? 1 : 0;
  }
  EXPECT_GT(bright, 60);
  EXPECT_GT(dark, 60);
  // And nowhere else along the axis.
  const double below = chart_point(chart, area, style, 0, 60.0).y;
  for (int x = 40; x < 180; ++x) {
    EXPECT_LT(pixel_at(with, {x + 0.5, below}).red, 60);
  }
}

TEST(strip_chart, newest_value_is_where_its_point_says) {
  const HudStyle style(1280, 720);
  const StripChart chart{.label = "log",
                         .values = {1e-4, 1e-2},
                         .slots = 30,
                         .lower = 1e-6,
                         .upper = 1.0,
                         .logarithmic = true};
  const PixelRectangle area{10.0, 10.0, 300.0, 110.0};
  Image image = black_image(320, 130);
  draw_chart(chart, area, style, image);
  const PixelPoint place = chart_point(chart, area, style, 1, 1e-2);
  EXPECT_GT(pixel_at(image, place).green, 200);
  EXPECT_LT(pixel_at(image, {place.x + 40.0, place.y}).green, 60);
}

TEST(hud, letters_stay_legible_in_small_pictures) {
  for (const auto& [width, height] : {std::pair{640, 360}, {360, 640}, {320, 180}}) {
    const HudStyle style(width, height);
    EXPECT_GE(style.small.size(), 9.0);
    EXPECT_GE(style.text.size(), 10.0);
  }
}

TEST(hud, panel_covers_less_than_half_of_any_picture) {
  for (const auto& [width, height] :
       {std::pair{1280, 720}, {640, 360}, {480, 270}, {320, 180}, {200, 100}}) {
    const Hud hud(width, height);
    Image image = black_image(width, height);
    hud.draw(talkative_frame(), image);
    EXPECT_LT(hud.covered_share(talkative_frame()), 0.45);
    EXPECT_EQ(image.rgb.size(), static_cast<std::size_t>(3 * width * height));
  }
}

TEST(legend, keeps_to_its_width_and_lines) {
  const HudStyle style(1280, 720);
  Frame frame = talkative_frame();
  frame.particles.resize(13);
  frame.ellipses.resize(13);
  frame.tube.resize(13);
  frame.raw_points.resize(5);
  frame.ghost = PlanarPose{};
  const Legend wide(frame, style, 2000.0, 3);
  const Legend narrow(frame, style, 400.0, 2);
  EXPECT_NEAR(wide.height(), style.row_height(), 1e-9);
  EXPECT_LE(narrow.width(), 400.0);
  EXPECT_NEAR(narrow.height(), 2.0 * style.row_height(), 1e-9);
}

}  // namespace hud_test
}  // namespace qsmpc::render
