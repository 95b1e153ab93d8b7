#include "harness/figures/svg_figure.hpp"

#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "harness/figures/palette.hpp"
#include "harness/report/page_assets.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace svg_figure_test {

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

PlaneMap map_of(const std::string& title) {
  return {
      .title = title,
      .note = "A note.",
      .x_label = "x (m)",
      .y_label = "y (m)",
      .area = MapRectangle{.x_upper = 10, .y_upper = 10},
      .bounds = {.x_lower = 1, .x_upper = 9, .y_lower = 1, .y_upper = 9},
      .obstacles = {{.x_lower = 2, .x_upper = 3, .y_lower = 2, .y_upper = 3}},
      .partial_obstacles = {{.x_lower = 4, .x_upper = 5, .y_lower = 2, .y_upper = 3}},
      .targets = {{.centre = {8, 8}, .radius = 0.5}},
      .contours = {{.name = "density", .lines = {{0.5, Eigen::Matrix2Xd::Identity(2, 2)}}}},
      .clouds = {{.name = "samples", .points = Eigen::Matrix2Xd::Ones(2, 3)}},
      .paths = {{.name = "driven",
                 .colour = kInk,
                 .points = {{1, 1}, {4, 4}, {8, 8}},
                 .start_mark = MapMark::kDot,
                 .end_mark = MapMark::kSquare,
                 .arrow_period = 2},
                {.name = "plan", .colour = kGrey, .points = {{1, 1}, {8, 8}}, .dashed = true},
                {.name = "others", .points = {{1, 1}, {8, 8}}, .faint = true}},
      .ellipses = {{.mean = {5, 5}, .covariance = Eigen::Matrix2d::Identity()}, {.mean = {5, 5}}},
      .labels = {{.text = "1 s", .at = {5, 5}}}};
}

TEST(SvgFigure, is_one_document_with_titles_notes_and_legends) {
  const std::string svg = svg_figure({chart_of("First"), chart_of("Second"), chart_of("Third")});
  EXPECT_TRUE(svg.starts_with("<?xml"));
  EXPECT_EQ(testing::occurrences(svg, "xmlns"), 1);
  for (const char* text : {"First", "Second", "Third"})
    EXPECT_TRUE(testing::contains(svg, text)) << text;
  EXPECT_EQ(testing::occurrences(svg, "A note."), 3);
  EXPECT_EQ(testing::occurrences(svg, ">plant<"), 3);
  EXPECT_EQ(testing::occurrences(svg, ">limit<"), 3);
  EXPECT_EQ(testing::tag_problem(svg.substr(svg.find("<svg"))), "");
  EXPECT_FALSE(testing::contains(svg, "var(")) << "few programs know variables";
  EXPECT_FALSE(testing::contains(svg, "href"));
}

TEST(SvgFigure, two_charts_stand_in_a_row_and_a_third_below) {
  const std::string two = svg_figure({chart_of("a"), chart_of("b")});
  EXPECT_TRUE(testing::contains(two, "width=\"1002\""));
  const std::string one = svg_figure({chart_of("a")});
  EXPECT_TRUE(testing::contains(one, "width=\"508\""));
  const std::string three = svg_figure({chart_of("a"), chart_of("b"), chart_of("c")});
  EXPECT_TRUE(testing::contains(three, "width=\"1002\""));
  EXPECT_FALSE(testing::contains(three, two.substr(two.find("height="), 12)));
}

TEST(SvgFigure, for_a_paper_has_no_titles_but_letters_and_the_width_of_its_columns) {
  const auto width_of = [](const std::string& svg) {
    return std::stod(svg.substr(svg.find(" width=\"") + 8));
  };
  const std::vector<Panel> panels = {chart_of("First"), chart_of("Second")};
  const std::string one = svg_figure(panels, {.titles = false, .columns = 1});
  EXPECT_FALSE(testing::contains(one, ">First<"));
  EXPECT_FALSE(testing::contains(one, "A note."));
  EXPECT_TRUE(testing::contains(one, ">(a)<"));
  EXPECT_TRUE(testing::contains(one, ">(b)<"));
  EXPECT_EQ(width_of(one), 336.0) << "3.5 inches";
  EXPECT_TRUE(testing::contains(one, "viewBox=\"0 0 508 ")) << "one panel in a row";
  const std::string two = svg_figure(panels, {.columns = 2});
  EXPECT_EQ(width_of(two), 687.0) << "7.16 inches";
  EXPECT_TRUE(testing::contains(two, "viewBox=\"0 0 1002 ")) << "two panels in a row";
  EXPECT_TRUE(testing::contains(two, ">First<"));
  EXPECT_FALSE(testing::contains(svg_figure({panels[0]}, {.titles = false}), "(a)"));
  const std::string alone = svg_figure({panels[0]}, {.columns = 2});
  EXPECT_EQ(width_of(alone), 336.0) << "its letters are those of panels side by side";
}

TEST(SvgFigure, a_chart_without_finite_values_says_so) {
  Chart empty = chart_of("Empty");
  empty.series[0].y = std::vector<double>(3, std::numeric_limits<double>::quiet_NaN());
  const std::string svg = svg_figure({empty});
  EXPECT_TRUE(testing::contains(svg, "No finite values to draw."));
  EXPECT_FALSE(testing::contains(svg, "nan"));
}

TEST(SvgFigure, texts_are_escaped) {
  Chart chart = chart_of("<b>");
  chart.series[0].name = "a & b";
  const std::string svg = svg_figure({chart});
  EXPECT_FALSE(testing::contains(svg, "<b>"));
  EXPECT_TRUE(testing::contains(svg, "a &amp; b"));
}

TEST(SvgFigure, a_chart_and_a_map_stand_side_by_side) {
  const std::string svg = svg_figure({chart_of("Chart"), map_of("Map")});
  EXPECT_EQ(testing::tag_problem(svg.substr(svg.find("<svg"))), "");
  for (const char* text : {">Chart<", ">Map<", ">driven<", ">samples<", ">target<", ">1 s<"}) {
    EXPECT_TRUE(testing::contains(svg, text)) << text;
  }
  EXPECT_EQ(testing::occurrences(svg, "A note."), 2);
  const MapSize size = map_size(map_of("Map"));
  EXPECT_TRUE(
      testing::contains(svg, " width=\"" + std::to_string(std::lround(size.width) + 522) + "\""));
  EXPECT_TRUE(
      testing::contains(svg, "<svg x=\"508.0\""));  // three margins of 14 and a chart of 480 in all
}

TEST(SvgFigure, maps_alone_need_no_panels) {
  const std::vector<PlaneMap> maps = {map_of("a"), map_of("b"), map_of("c")};
  EXPECT_EQ(svg_figure(maps), svg_figure({maps[0], maps[1], maps[2]}));
}

TEST(SvgFigure, an_empty_map_says_so) {
  EXPECT_TRUE(
      testing::contains(svg_figure({PlaneMap{.title = "Empty"}}), "No finite values to draw."));
}

TEST(SvgFigure, of_nothing_is_a_document) {
  const std::string svg = svg_figure(std::vector<Panel>{});
  EXPECT_EQ(testing::tag_problem(svg.substr(svg.find("<svg"))), "");
}

TEST(SvgFigure, every_class_has_a_style_in_the_file_and_on_a_page) {
  Chart chart = chart_of("Chart");
  chart.areas.push_back({.name = "shaded", .x = {1, 2, 2}, .y = {0.1, 0.1, 0.3}});
  const std::string svg = svg_figure({chart, map_of("Map")});
  const std::size_t end = svg.find("</style>");
  const std::string style = svg.substr(0, end);
  const std::string page(page_style());
  const std::string body = svg.substr(end);
  std::set<std::string> classes;
  const std::regex attribute("class=\"([^\"]*)\"");
  const std::regex word("[a-z0-9-]+");
  for (std::sregex_iterator it(body.begin(), body.end(), attribute), last; it != last; ++it) {
    const std::string names = (*it)[1];
    for (std::sregex_iterator name(names.begin(), names.end(), word); name != last; ++name) {
      classes.insert(name->str());
    }
  }
  EXPECT_GT(classes.size(), 20U);
  for (const std::string& name : classes) {
    const std::regex rule("\\." + name + "[ ,{.]");
    if (name != "clip") {  // an <svg> within another one clips by default
      EXPECT_TRUE(std::regex_search(style, rule)) << name;
    }
    if (name != "title") {  // a page has a <figcaption>
      EXPECT_TRUE(std::regex_search(page, rule)) << name;
    }
  }
}

TEST(SvgFigure, entries_of_a_legend_stand_side_by_side_while_they_fit) {
  Chart chart = chart_of("Chart");
  const double low =
      std::stod(svg_figure({chart}).substr(svg_figure({chart}).find("height=\"") + 8));
  chart.series.push_back(chart.series[0]);  // a third one in the line
  EXPECT_TRUE(
      testing::contains(svg_figure({chart}), "height=\"" + std::to_string(std::lround(low))));
  chart.series.back().name = std::string(100, 'm');  // two lines, and the limit below
  EXPECT_TRUE(
      testing::contains(svg_figure({chart}), "height=\"" + std::to_string(std::lround(low) + 51)));
}

TEST(ChartDrawing, names_stand_in_place_of_numbers) {
  Chart chart = chart_of("Names");
  chart.x_names = {"x (m)", "y (m)", "heading (rad)"};
  const std::string svg = chart_drawing(chart);
  for (const std::string& name : chart.x_names)
    EXPECT_TRUE(testing::contains(svg, ">" + name + "<"));
  EXPECT_FALSE(testing::contains(svg, ">1.5<"));
}

}  // namespace svg_figure_test
}  // namespace qsmpc::harness
