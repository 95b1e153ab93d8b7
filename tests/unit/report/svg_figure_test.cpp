#include "harness/report/svg_figure.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/report/page_checks.hpp"

namespace qsmpc {
namespace {

using testing::contains;
using testing::occurrences;
using testing::tag_problem;

Chart chart_of(const std::string& title) {
  return {.title = title,
          .note = "A note.",
          .x_label = "stage",
          .y_label = "distance (m)",
          .series = {{.name = "plant", .x = {1, 2, 3}, .y = {0.1, 0.3, 0.2}}},
          .rules = {{"limit", 0.25}}};
}

TEST(SvgFigure, is_one_document_with_titles_notes_and_legends) {
  const std::string svg = svg_figure({chart_of("First"), chart_of("Second"), chart_of("Third")});
  EXPECT_TRUE(svg.starts_with("<?xml"));
  EXPECT_EQ(occurrences(svg, "xmlns"), 1);
  for (const char* text : {"First", "Second", "Third"}) EXPECT_TRUE(contains(svg, text)) << text;
  EXPECT_EQ(occurrences(svg, "A note."), 3);
  EXPECT_EQ(occurrences(svg, ">plant<"), 3);
  EXPECT_EQ(occurrences(svg, ">limit<"), 3);
  EXPECT_EQ(tag_problem(svg.substr(svg.find("<svg"))), "");
  EXPECT_FALSE(contains(svg, "var(")) << "few programs know variables";
  EXPECT_FALSE(contains(svg, "href"));
}

TEST(SvgFigure, two_charts_stand_in_a_row_and_a_third_below) {
  const std::string two = svg_figure({chart_of("a"), chart_of("b")});
  EXPECT_TRUE(contains(two, "width=\"1002\""));
  const std::string one = svg_figure({chart_of("a")});
  EXPECT_TRUE(contains(one, "width=\"508\""));
  const std::string three = svg_figure({chart_of("a"), chart_of("b"), chart_of("c")});
  EXPECT_TRUE(contains(three, "width=\"1002\""));
  EXPECT_FALSE(contains(three, two.substr(two.find("height="), 12)));
}

TEST(SvgFigure, a_chart_without_finite_values_says_so) {
  Chart empty = chart_of("Empty");
  empty.series[0].y = std::vector<double>(3, std::numeric_limits<double>::quiet_NaN());
  const std::string svg = svg_figure({empty});
  EXPECT_TRUE(contains(svg, "No finite values to draw."));
  EXPECT_FALSE(contains(svg, "nan"));
}

TEST(SvgFigure, texts_are_escaped) {
  Chart chart = chart_of("<b>");
  chart.series[0].name = "a & b";
  const std::string svg = svg_figure({chart});
  EXPECT_FALSE(contains(svg, "<b>"));
  EXPECT_TRUE(contains(svg, "a &amp; b"));
}

TEST(ChartDrawing, names_stand_in_place_of_numbers) {
  Chart chart = chart_of("Names");
  chart.x_names = {"x (m)", "y (m)", "heading (rad)"};
  const std::string svg = chart_drawing(chart);
  for (const std::string& name : chart.x_names) EXPECT_TRUE(contains(svg, ">" + name + "<"));
  EXPECT_FALSE(contains(svg, ">1.5<"));
}

}  // namespace
}  // namespace qsmpc
