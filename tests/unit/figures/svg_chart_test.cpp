#include "harness/figures/svg_chart.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "harness/text/text_width.hpp"
#include "models/constants.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace svg_chart_test {

using testing::contains;
using testing::occurrences;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Axis, ticks_are_at_round_numbers_and_span_the_values) {
  const Axis axis = rounded_axis({0.13, 9.2}, 5);
  EXPECT_DOUBLE_EQ(axis.lower, 0.0);
  EXPECT_DOUBLE_EQ(axis.upper, 10.0);
  const auto ticks = ticks_of(axis, 5);
  ASSERT_EQ(ticks.size(), 6U);
  EXPECT_EQ(ticks.front().label, "0");
  EXPECT_EQ(ticks[1].label, "2");
  EXPECT_EQ(ticks.back().label, "10");
}

TEST(Axis, a_power_of_ten_shared_by_labels_is_shown_once) {
  EXPECT_EQ(common_power(rounded_axis({0.0, 2.2e-6}, 5), 5), -6);
  EXPECT_EQ(common_power(rounded_axis({0.0, 2.4e9}, 5), 5), 9);
  EXPECT_EQ(common_power(rounded_axis({0.0, 90'000.0}, 5), 5), 0);
  EXPECT_EQ(common_power(rounded_axis({0.0, 0.01}, 5), 5), 0);
  EXPECT_EQ(common_power(log_axis({1e-8, 1e8}, 1e-12), 5), 0);

  Chart chart{.title = "t", .x_label = "x", .y_label = "pole_angle (rad)"};
  chart.series = {{.name = "s", .x = {0.0, 1.0}, .y = {0.0, 2.2e-6}}};
  const std::string drawing = chart_drawing(chart);
  EXPECT_TRUE(contains(drawing, ">pole_angle (10⁻⁶ rad)<"));
  EXPECT_TRUE(contains(drawing, ">1.5<"));
  EXPECT_FALSE(contains(drawing, "× 10"));
  chart.y_label = "share (–)";
  EXPECT_TRUE(contains(chart_drawing(chart), ">share (10⁻⁶)<"));
}

TEST(Axis, equal_values_still_have_an_axis_about_them) {
  for (const double value : {0.0, -3.0, 1e17, 1e-30}) {
    const Axis axis = rounded_axis({value, value}, 5);
    EXPECT_LT(axis.lower, axis.upper) << value;
    const double position = position_on(axis, value);
    EXPECT_GE(position, 0.0) << value;
    EXPECT_LE(position, 1.0) << value;
    EXPECT_LT(ticks_of(axis, 5).size(), 20U) << value;
  }
}

TEST(Axis, values_that_are_not_finite_do_not_count) {
  const Axis axis = tight_axis({kNan, 1.0, kInfinity, 2.0, -kInfinity, 1e300});
  EXPECT_DOUBLE_EQ(axis.lower, 1.0);
  EXPECT_DOUBLE_EQ(axis.upper, 2.0);
}

TEST(Axis, a_logarithmic_axis_has_whole_decades_and_a_foot) {
  const Axis axis = log_axis({0.0, 3e-5, 0.2, 1e-40}, 1e-12);
  EXPECT_NEAR(std::log10(axis.lower), -12.0, 1e-9);  // rounding of pow and log10
  EXPECT_NEAR(std::log10(axis.upper), 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(position_on(axis, 0.0), 0.0);
  EXPECT_NEAR(position_on(axis, 1e-6), 0.5, 1e-9);
}

TEST(Axis, a_logarithmic_axis_without_positive_values_exists) {
  const Axis axis = log_axis({0.0, -1.0, kNan}, 1e-3);
  EXPECT_GT(axis.lower, 0.0);
  EXPECT_LT(axis.lower, axis.upper);
}

TEST(Axis, zero_has_a_place_left_of_a_logarithmic_axis_where_it_is_kept_one) {
  Axis axis = log_axis({1e-3, 1.0}, 1e-12);
  EXPECT_DOUBLE_EQ(position_on(axis, 0.0), position_on(axis, axis.lower));
  axis.zero_share = 0.2;
  EXPECT_DOUBLE_EQ(position_on(axis, 0.0), 0.1);
  EXPECT_DOUBLE_EQ(position_on(axis, axis.lower), 0.2);
  EXPECT_DOUBLE_EQ(position_on(axis, 1e-9), 0.2) << "not 0, but off the axis";
  EXPECT_DOUBLE_EQ(position_on(axis, axis.upper), 1.0);
  EXPECT_EQ(ticks_of(axis, 6).front().label, "0");
  EXPECT_EQ(ticks_of(axis, 6).size(), 5U);
}

TEST(Axis, minor_ticks_stand_between_few_decades) {
  EXPECT_EQ(minor_ticks_of(log_axis({1e-3, 1.0}, 1e-12)).size(), 3U * 8U);
  EXPECT_TRUE(minor_ticks_of(log_axis({1e-8, 1.0}, 1e-12)).empty());
  EXPECT_TRUE(minor_ticks_of({.lower = 0.0, .upper = 1.0}).empty());
}

Chart example_chart() {
  return {.title = "Clearance",
          .x_label = "time (s)",
          .y_label = "clearance (m)",
          .series = {{.name = "true state", .x = {0, 1, 2, 3}, .y = {1, 3, 2, 4}}},
          .rules = {{"limit", 0.5}}};
}

TEST(ChartFigure, has_title_labels_and_legend) {
  const std::string html = chart_figure(example_chart());
  for (const char* text : {"Clearance", "time (s)", "clearance (m)", "true state", "limit"}) {
    EXPECT_TRUE(testing::contains(html, text));
  }
}

TEST(ChartFigure, a_gap_interrupts_the_line_and_is_noted) {
  Chart chart = example_chart();
  chart.series[0].y[1] = kNan;
  const std::string html = chart_figure(chart);
  EXPECT_FALSE(testing::contains(html, "nan"));
  EXPECT_TRUE(testing::contains(html, "1 value is not finite and not drawn"));
  // The first point is isolated and drawn as a dot; the last two form a line.
  EXPECT_EQ(testing::occurrences(html, "<path class=\"points c0\" d=\"M78.0 "), 1);
  const std::size_t line = html.rfind("<path class=\"line c0\" d=\"M");
  const std::string data = html.substr(line, html.find('>', line) - line);
  EXPECT_EQ(testing::occurrences(data, "M"), 1);
  EXPECT_EQ(testing::occurrences(data, "L"), 1);
}

TEST(ChartFigure, without_any_finite_value_it_says_so) {
  Chart chart = example_chart();
  chart.series[0].y = {kNan, kInfinity, -kInfinity, kNan};
  const std::string html = chart_figure(chart);
  EXPECT_TRUE(testing::contains(html, "No finite values to draw"));
  EXPECT_TRUE(testing::contains(html, "4 values are not finite"));
  EXPECT_FALSE(testing::contains(html, "viewBox=\"0 0 480"));
}

TEST(ChartFigure, texts_are_escaped) {
  Chart chart = example_chart();
  chart.title = chart.x_label = chart.y_label = chart.note = "<b>";
  chart.series[0].name = chart.rules[0].name = "<i>";
  const std::string html = chart_figure(chart);
  EXPECT_FALSE(testing::contains(html, "<b>"));
  EXPECT_FALSE(testing::contains(html, "<i>"));
}

TEST(ChartFigure, a_long_line_is_thinned_but_keeps_its_extremes) {
  Chart chart = example_chart();
  Series& series = chart.series[0];
  series.x.clear();
  series.y.clear();
  for (int i = 0; i < 200000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 77777 ? 1000.0 : 0.5);
  }
  const std::string html = chart_figure(chart);
  EXPECT_LT(html.size(), 100000U);
  EXPECT_TRUE(testing::contains(html, " 10.0"));  // the peak reaches the top of the frame
}

/// Two points with error bars in both directions; one of them at 0.
Chart joined_chart() {
  return {.title = "Risk",
          .x_label = "rate",
          .y_label = "cost",
          .x_scale = Scale::kLog,
          .least_x = 1e-3,
          .x_has_zero = true,
          .x_includes = {1e-3},
          .series = {{.name = "family",
                      .mark = Mark::kJoined,
                      .x = {0.0, 0.1},
                      .y = {10.0, 5.0},
                      .lower = {9.0, 4.0},
                      .upper = {11.0, 6.0},
                      .x_lower = {0.0, 1e-5},
                      .x_upper = {0.05, 0.3},
                      .labels = {"strict", "<b>lenient"}}}};
}

/// The data of the first path with this class.
std::string path_of_class(const std::string& svg, const std::string& classes) {
  const std::string head = "<path class=\"" + classes + "\" d=\"";
  const std::size_t begin = svg.find(head);
  if (begin == std::string::npos) return "";
  return svg.substr(begin + head.size(), svg.find('"', begin + head.size()) - begin - head.size());
}

TEST(JoinedPoints, have_a_line_marks_and_labels) {
  const std::string svg = chart_drawing(joined_chart());
  const std::string line = path_of_class(svg, "way faint c0");
  EXPECT_EQ(testing::occurrences(line, "M"), 1);
  EXPECT_EQ(testing::occurrences(line, "L"), 1);
  EXPECT_EQ(testing::occurrences(path_of_class(svg, "points c0"), "M"), 2);
  EXPECT_TRUE(testing::contains(svg, ">strict</text>"));
  EXPECT_TRUE(testing::contains(svg, "&lt;b&gt;lenient</text>"));
  EXPECT_FALSE(testing::contains(svg, "<b>"));
}

TEST(JoinedPoints, one_that_is_not_finite_interrupts_the_line_and_has_no_label) {
  Chart chart = joined_chart();
  chart.series[0].y[0] = kNan;
  const std::string svg = chart_drawing(chart);
  EXPECT_FALSE(testing::contains(path_of_class(svg, "way faint c0"), "L"));
  EXPECT_FALSE(testing::contains(svg, "strict"));
  EXPECT_FALSE(testing::contains(svg, "nan"));
}

TEST(ErrorBars, end_in_strokes_and_in_an_arrow_where_the_axis_cuts_them_off) {
  Chart chart = joined_chart();
  const std::string both = path_of_class(chart_drawing(chart), "line thin c0");
  EXPECT_EQ(testing::occurrences(both, "l-4 3l4 3"), 1) << "10⁻⁵ is off the axis";
  EXPECT_EQ(testing::occurrences(both, "h6m-3"), 2) << "of the vertical bars";
  EXPECT_EQ(testing::occurrences(both, "m0 -3v6"), 2) << "right ends";
  EXPECT_EQ(testing::occurrences(both, "v6M"), 1) << "no left end at 0 but that of the next bar";
  chart.series[0].x_lower[1] = 0.02;
  const std::string within = path_of_class(chart_drawing(chart), "line thin c0");
  EXPECT_EQ(testing::occurrences(within, "l-4 3l4 3"), 0);
}

TEST(ErrorBars, are_not_cut_off_at_their_upper_end) {
  Chart chart = joined_chart();
  chart.series[0].x_upper[1] = 1.0;
  const std::string svg = chart_drawing(chart);
  EXPECT_TRUE(testing::contains(svg, "H466.0m0 -3v6")) << "the right end of the axis";
}

TEST(PointLabels, never_cover_each_other) {
  Chart chart = joined_chart();
  Series& series = chart.series[0];
  for (int n = 0; n < 60; ++n) {  // far more than there is room for
    series.x.push_back(0.1);
    series.y.push_back(5.0);
    series.labels.emplace_back("crowded");
  }
  const int drawn = testing::occurrences(chart_drawing(chart), "crowded");
  EXPECT_GE(drawn, 3);
  EXPECT_LT(drawn, 30);
}

TEST(ChartFigure, a_long_label_of_y_takes_two_lines) {
  Chart chart = joined_chart();
  EXPECT_EQ(testing::occurrences(chart_drawing(chart), "rotate(-90)"), 1);
  chart.y_label = "mean cost of the drives that reached the target (–)";
  EXPECT_EQ(testing::occurrences(chart_drawing(chart), "rotate(-90)"), 2);
}

TEST(ChartFigure, is_described_in_words) {
  Chart chart = joined_chart();
  EXPECT_TRUE(testing::contains(chart_drawing(chart), "aria-label=\"Risk: cost\""));
  chart.in_words = "strict: \"10\"";
  EXPECT_TRUE(testing::contains(chart_drawing(chart), "aria-label=\"strict: &quot;10&quot;\""));
}

TEST(ChartFigure, the_name_at_the_end_of_an_axis_stays_within_the_drawing) {
  Chart chart{
      .title = "t",
      .x_label = "state",
      .y_label = "y",
      .x_names = {"position (m)", "velocity (m/s)", "pole_angle (rad)", "angular_velocity (rad/s)"},
      .x_includes = {0.5, 4.5}};
  chart.series = {{.name = "s", .mark = Mark::kPoints, .x = {1.0, 4.0}, .y = {0.0, 1.0}}};
  const std::string drawing = chart_drawing(chart);
  const std::size_t end = drawing.find(">angular_velocity");
  ASSERT_NE(end, std::string::npos);
  const std::size_t begin = drawing.rfind(" x=\"", end) + 4;
  const double middle = std::stod(drawing.substr(begin));
  EXPECT_LE(middle + 0.5 * estimated_width("angular_velocity (rad/s)", 14.5), kChartWidth + 0.1);
}

}  // namespace svg_chart_test
}  // namespace qsmpc::harness
