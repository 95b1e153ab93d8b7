#include "render/hud/canvas.hpp"

#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/hud/hud.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
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
  Canvas(image).fill_rectangle({4.0, 5.0, 6.0, 3.0}, kWhite);
  EXPECT_EQ(brightness(image), 255L * 3 * 6 * 3);
  EXPECT_EQ(pixel_at(image, {4.5, 5.5}).red, 255);
  EXPECT_EQ(pixel_at(image, {10.5, 5.5}).red, 0);
}

TEST(canvas, colours_are_blended_by_their_opacity) {
  Image image = black_image(4, 4);
  Canvas(image).fill_rectangle({0.0, 0.0, 4.0, 4.0}, {0.8F, 0.4F, 0.2F, 0.5F});
  EXPECT_LE(colour_difference(pixel_at(image, {2.0, 2.0}), {0.4F, 0.2F, 0.1F}), 1);
}

TEST(canvas, shapes_beyond_the_edges_are_cut_off) {
  Image image = black_image(20, 20);
  {
    Canvas canvas(image);
    canvas.fill_rectangle({-5.0, -5.0, 100.0, 100.0}, kWhite, 3.0);
    canvas.fill_circle({25.0, -3.0}, 12.0, kWhite);
    canvas.draw_text(Font(14.0), "far beyond the edge", {-30.0, 22.0}, kWhite);
    canvas.draw_graph({{-10.0, -50.0}, {40.0, 1e300}}, 2.0, kWhite);
  }
  EXPECT_EQ(pixel_at(image, {10.0, 10.0}).red, 255);
}

TEST(canvas, part_of_an_image_is_all_that_changes) {
  for (const PixelRectangle& area :
       {PixelRectangle{4.0, 6.0, 5.0, 7.0}, {-3.0, 12.0, 8.0, 90.0}, {50.0, 50.0, 9.0, 9.0}}) {
    Image image = black_image(20, 20);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      image.rgb[i] = static_cast<unsigned char>(i % 251);
    }
    const Image before = image;
    Canvas(image, area).fill_rectangle({-100.0, -100.0, 300.0, 300.0}, kWhite);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const bool within =
            x >= area.x && x < area.x + area.width && y >= area.y && y < area.y + area.height;
        const PixelPoint place{x + 0.5, y + 0.5};
        const Pixel expected = within ? Pixel{255, 255, 255} : pixel_at(before, place);
        EXPECT_EQ(pixel_at(image, place).red, expected.red) << x << ", " << y;
        EXPECT_EQ(pixel_at(image, place).blue, expected.blue) << x << ", " << y;
      }
    }
  }
}

TEST(canvas, text_is_as_wide_as_the_font_says) {
  const Font font(16.0);
  Image image = black_image(200, 30);
  Canvas(image).draw_text(font, "stage 8", {10.0, 20.0}, kWhite);
  int last = 0;
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < image.height; ++y) {
      last = pixel_at(image, {x + 0.5, y + 0.5}).red > 100 ? x : last;
    }
  }
  EXPECT_NEAR(last, 10.0 + font.width("stage 8"), 3.0);  // the last letter's own margin
}

Image picture_of(std::string_view text) {
  Image image = black_image(200, 40);
  Canvas(image).draw_text(Font(20.0), text, {5.0, 28.0}, kWhite);
  return image;
}

TEST(canvas, letters_beyond_ascii_are_drawn_as_themselves) {
  const std::vector<std::string> letters{"µ", "σ", "Σ", "é", "Ö", "ž", "Ж", "≤", "⁻", "∞", "−"};
  std::set<std::vector<unsigned char>> pictures{picture_of("?").rgb, picture_of("\xEF\xBF\xBD").rgb,
                                                picture_of("\U0010FFFD").rgb};
  const std::size_t others = pictures.size();
  for (const std::string& letter : letters) {
    EXPECT_GT(brightness(picture_of(letter)), 0) << letter;
    pictures.insert(picture_of(letter).rgb);
  }
  EXPECT_EQ(pictures.size(), others + letters.size());
  EXPECT_NEAR(Font(20.0).width("σµ"), Font(20.0).width("σ") + Font(20.0).width("µ"), 1e-9);
}

TEST(canvas, bytes_that_are_not_utf8_are_replaced_one_by_one) {
  const std::string replaced =
      "a\xEF\xBF\xBD"
      "b";
  for (const char* bytes : {"a\xFF"
                            "b",
                            "a\x80"
                            "b",
                            "a\xC3"
                            "b",
                            "a\xF8"
                            "b"}) {
    EXPECT_EQ(picture_of(bytes).rgb, picture_of(replaced).rgb);
  }
  // A surrogate, an overlong '/', a value above the last code point, and a truncated sequence.
  for (const char* bytes : {"\xED\xA0\x80", "\xE0\x80\xAF", "\xF5\x80\x80", "\xF0\x9F\x98"}) {
    EXPECT_EQ(picture_of(bytes).rgb, picture_of("\uFFFD\uFFFD\uFFFD").rgb);
  }
  // U+10FFFF, which is not a character.
  EXPECT_EQ(picture_of("\xF4\x8F\xBF\xBF").rgb, picture_of("\uFFFD\uFFFD\uFFFD\uFFFD").rgb);
  EXPECT_EQ(picture_of("a\nb\tc").rgb, picture_of("a b c").rgb);
}

TEST(canvas, text_is_drawn_where_no_font_is_installed) {
  // In a process that has not looked for fonts yet.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string configuration = fresh_folder() / "fonts.conf";
  std::ofstream(configuration) << "<?xml version=\"1.0\"?><fontconfig/>";
  const auto draw = [&] {
    setenv("FONTCONFIG_FILE", configuration.c_str(), 1);
    const bool drawn = brightness(picture_of("letters")) > 0 &&
                       picture_of("letters").rgb != picture_of("digits").rgb &&
                       Font(20.0).width("letters") > 0.0;
    std::_Exit(drawn ? EXIT_SUCCESS : EXIT_FAILURE);
  };
  EXPECT_EXIT(draw(), ::testing::ExitedWithCode(EXIT_SUCCESS), "");
}

TEST(canvas, fitting_text_is_cut_between_letters) {
  const Font font(14.0);
  const std::string text = "σµσµσµσµσµσµ";
  EXPECT_EQ(fitting(font, text, font.width(text)), text);
  const std::string cut = fitting(font, text, 0.5 * font.width(text));
  EXPECT_LE(font.width(cut), 0.5 * font.width(text));
  EXPECT_GT(font.width(cut), 0.3 * font.width(text));
  ASSERT_THAT(cut, ::testing::EndsWith("…"));
  EXPECT_THAT(text, ::testing::StartsWith(cut.substr(0, cut.size() - 3)));
  EXPECT_EQ((cut.size() - 3) % 2, 0U);  // each letter is two bytes
  EXPECT_EQ(fitting(font, "wide", 0.0), "…");
}

TEST(canvas, graph_stops_at_a_value_that_is_not_finite) {
  Image image = black_image(40, 20);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Canvas(image).draw_graph({{0.0, 10.0}, {10.0, 10.0}, {20.0, nan}, {30.0, 10.0}, {39.0, 10.0}},
                           2.0, kWhite);
  EXPECT_EQ(pixel_at(image, {5.0, 10.0}).red, 255);
  EXPECT_EQ(pixel_at(image, {20.0, 10.0}).red, 0);
  EXPECT_EQ(pixel_at(image, {35.0, 10.0}).red, 255);
}

Image hud_picture(int index) {
  Frame frame;
  frame.title = "σ and µ";
  frame.hud = {{"time", std::to_string(index) + " s"}};
  frame.charts = {{.label = "curve", .values = {0.1, 0.9, 0.4}, .slots = 5}};
  frame.banner = "two threads";
  Image image = black_image(640, 360);
  const Hud hud(640, 360);
  hud.draw_column(frame, {0.0, 0.0, 160.0, 360.0}, image);
  hud.draw_legend_band(frame, {160.0, 320.0, 480.0, 40.0}, image);
  hud.draw_banner(frame, {160.0, 0.0, 480.0, 320.0}, {}, image);
  return image;
}

TEST(hud, threads_draw_the_same_pictures_at_once_as_one_alone) {
  constexpr int kPictures = 24;
  std::vector<Image> first(kPictures);
  std::vector<Image> second(kPictures);
  const auto draw_all = [](std::vector<Image>& images) {
    for (int i = 0; i < kPictures; ++i) images[static_cast<std::size_t>(i)] = hud_picture(i);
  };
  std::thread one([&] { draw_all(first); });
  std::thread two([&] { draw_all(second); });
  one.join();
  two.join();
  for (int i = 0; i < kPictures; ++i) {
    const Image alone = hud_picture(i);
    EXPECT_EQ(first[static_cast<std::size_t>(i)].rgb, alone.rgb) << i;
    EXPECT_EQ(second[static_cast<std::size_t>(i)].rgb, alone.rgb) << i;
  }
}

TEST(hud, a_banner_that_is_an_alarm_is_red) {
  const auto redness = [](bool alarm) {
    Frame frame;
    frame.banner = "collision";
    frame.alarm = alarm;
    Image image = black_image(640, 360);
    Hud(640, 360).draw_banner(frame, {0.0, 0.0, 640.0, 360.0}, {}, image);
    int surplus = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      surplus += image.rgb[i] - image.rgb[i + 1] > 100 ? 1 : 0;
    }
    return surplus;
  };
  EXPECT_EQ(redness(false), 0);
  EXPECT_GT(redness(true), 1000);
}

TEST(hud, draws_no_banner_for_a_frame_without) {
  Image image = black_image(640, 360);
  Hud(640, 360).draw_banner(Frame{}, {0.0, 0.0, 640.0, 360.0}, {}, image);
  EXPECT_EQ(brightness(image), 0);
}

TEST(hud, survives_long_and_foreign_text_and_values_that_are_not_finite) {
  Frame frame;
  frame.title = std::string(300, 'W');
  frame.hud = {{std::string(200, 'n'), std::string(200, 'v')}, {"rate", "\xCF\x89 \xCF"}};
  frame.charts = {{.label = "log",
                   .values = {0.0, -1.0, std::nan("")},
                   .lower = 1e-4,
                   .upper = 1.0,
                   .logarithmic = true}};
  frame.banner = std::string(300, 'b');
  Image image = black_image(640, 360);
  const Hud hud(640, 360);
  hud.draw_column(frame, {0.0, 0.0, hud.column_width(), 360.0}, image);
  hud.draw_band(frame, {160.0, 300.0, 480.0, 60.0}, image);
  hud.draw_banner(frame, {160.0, 0.0, 480.0, 300.0}, {}, image);
  hud.draw_line(frame, {0.0, 0.0, 640.0, 24.0}, image);
  EXPECT_GT(brightness(image), 0);
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
}  // namespace qsmpc::render
