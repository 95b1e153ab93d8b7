#include "render/hud/canvas.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "render/hud/hud.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc {
namespace canvas_test {

constexpr Colour kWhite{1.0F, 1.0F, 1.0F};

Image black_image(int width, int height) {
  return {width, height, std::vector<unsigned char>(static_cast<std::size_t>(3 * width * height))};
}

long brightness(const Image& image) {
  long sum = 0;
  for (const unsigned char value : image.rgb) {
    sum += value;
  }
  return sum;
}

TEST(canvas, rectangle_covers_its_area_and_nothing_else) {
  Image image = black_image(20, 20);
  fill_rectangle(image, {4.0, 5.0, 6.0, 3.0}, kWhite);
  EXPECT_EQ(brightness(image), 255L * 3 * 6 * 3);
  EXPECT_EQ(pixel_at(image, {4.5, 5.5}).red, 255);
  EXPECT_EQ(pixel_at(image, {10.5, 5.5}).red, 0);
}

TEST(canvas, shapes_beyond_the_edges_are_cut_off) {
  Image image = black_image(20, 20);
  const Font font(14.0);
  fill_rectangle(image, {-5.0, -5.0, 100.0, 100.0}, kWhite, 3.0);
  fill_circle(image, {25.0, -3.0}, 12.0, kWhite);
  draw_text(image, font, "far beyond the edge", {-30.0, 22.0}, kWhite);
  draw_graph(image, {{-10.0, -50.0}, {40.0, 90.0}}, 2.0, kWhite);
  EXPECT_EQ(pixel_at(image, {10.0, 10.0}).red, 255);
}

TEST(canvas, text_is_as_wide_as_the_font_says) {
  const Font font(16.0);
  Image image = black_image(200, 30);
  draw_text(image, font, "stage 8", {10.0, 20.0}, kWhite);
  int last = 0;
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < image.height; ++y) {
      last = pixel_at(image, {x + 0.5, y + 0.5}).red > 100 ? x : last;
    }
  }
  EXPECT_NEAR(last, 10.0 + font.width("stage 8"), 3.0);  // the last letter's own margin
}

TEST(canvas, graph_stops_at_a_value_that_is_not_finite) {
  Image image = black_image(40, 20);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  draw_graph(image, {{0.0, 10.0}, {10.0, 10.0}, {20.0, nan}, {30.0, 10.0}, {39.0, 10.0}}, 2.0,
             kWhite);
  EXPECT_EQ(pixel_at(image, {5.0, 10.0}).red, 255);
  EXPECT_EQ(pixel_at(image, {20.0, 10.0}).red, 0);
  EXPECT_EQ(pixel_at(image, {35.0, 10.0}).red, 255);
}

TEST(hud, draws_nothing_for_a_frame_that_says_nothing) {
  Image image = black_image(640, 360);
  const Hud hud(640, 360);
  hud.draw(Frame{}, image);
  EXPECT_EQ(brightness(image), 0);
  EXPECT_EQ(hud.covered_share(Frame{}), 0.0);
}

TEST(hud, survives_long_and_foreign_text_and_values_that_are_not_finite) {
  Frame frame;
  frame.title = std::string(300, 'W');
  frame.hud = {{std::string(200, 'n'), std::string(200, 'v')}, {"rate", "\xCF\x89"}};
  frame.charts = {{.label = "log",
                   .values = {0.0, -1.0, std::nan("")},
                   .lower = 1e-4,
                   .upper = 1.0,
                   .logarithmic = true}};
  frame.banner = std::string(300, 'b');
  Image image = black_image(640, 360);
  const Hud hud(640, 360);
  hud.draw(frame, image);
  EXPECT_GT(brightness(image), 0);
  EXPECT_GT(hud.covered_share(frame), 0.0);
}

TEST(colour, stages_get_brighter_along_the_horizon) {
  for (int stage = 1; stage < 9; ++stage) {
    const Colour before = stage_colour(stage - 1, 9);
    const Colour after = stage_colour(stage, 9);
    const auto luma = [](const Colour& c) { return 0.3F * c.red + 0.6F * c.green + 0.1F * c.blue; };
    EXPECT_GT(luma(after), luma(before)) << stage;
  }
}

}  // namespace canvas_test
}  // namespace qsmpc
