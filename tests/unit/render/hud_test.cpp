#include "render/hud/hud.hpp"

#include <gtest/gtest.h>

#include "render/hud/legend.hpp"
#include "render/hud/strip_chart.hpp"
#include "render/picture_layout.hpp"
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

TEST(strip_chart, numbers_are_short_and_as_people_read_them) {
  EXPECT_EQ(short_number(-0.0), "0");
  EXPECT_EQ(short_number(-0.785), "−0.785");
  EXPECT_EQ(short_number(100.0), "100");
  EXPECT_EQ(short_number(1234.4), "1234");
  EXPECT_EQ(short_number(1e5), "10⁵");
  EXPECT_EQ(short_number(3.5e-6), "3.5 × 10⁻⁶");
  EXPECT_EQ(short_number(1e-3), "0.001");
}

TEST(hud, leaves_the_scene_most_of_the_picture_and_never_lies_over_it) {
  for (const auto& [width, height] :
       {std::pair{1280, 720}, {640, 360}, {480, 270}, {320, 180}, {200, 100}}) {
    const Hud hud(width, height);
    const PictureLayout layout = picture_layout(width, height, "chase", 1,
                                                {.charts = hud.band_height(),
                                                 .legend = hud.legend_height(2),
                                                 .column = hud.column_width(),
                                                 .line = hud.heading_height()});
    const PaneLayout& pane = layout.panes.at(0);
    EXPECT_GT(pane.width * pane.height, 0.55 * width * height) << width;
    const auto apart = [&pane](const PixelRectangle& area) {
      return area.x + area.width <= pane.x || area.y + area.height <= pane.y ||
             area.x >= pane.x + pane.width || area.y >= pane.y + pane.height;
    };
    EXPECT_TRUE(apart(layout.bands.at(0))) << width;
    EXPECT_TRUE(layout.legend.height == 0.0 || apart(layout.legend)) << width;
  }
}

TEST(hud, column_is_drawn_within_its_area) {
  const Hud hud(640, 360);
  Image image = black_image(640, 360);
  hud.draw_column(talkative_frame(), {0.0, 0.0, hud.column_width(), 360.0}, image);
  int lit = 0;
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 640; ++x) {
      const int light = pixel_at(image, {x + 0.5, y + 0.5}).green;
      if (x >= hud.column_width()) {
        ASSERT_EQ(light, 0) << x << ", " << y;
      } else {
        lit += light > 100 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(lit, 100);
}

TEST(hud, banner_keeps_off_what_it_must_not_cover) {
  const auto light_at = [](const PixelPoint& place) {
    Frame frame;
    frame.banner = "target reached";
    frame.alarm = true;
    Image image = black_image(640, 360);
    Hud(640, 360).draw_banner(frame, {0.0, 0.0, 640.0, 360.0}, {place}, image);
    return pixel_at(image, place).red;
  };
  EXPECT_EQ(light_at({320.0, 40.0}), 0);
  EXPECT_EQ(light_at({320.0, 320.0}), 0);
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
