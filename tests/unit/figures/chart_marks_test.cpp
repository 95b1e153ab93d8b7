#include "harness/figures/chart_marks.hpp"

#include <set>

#include <gtest/gtest.h>

#include "harness/figures/palette.hpp"
#include "harness/figures/svg_chart.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace chart_marks_test {

using testing::contains;
using testing::occurrences;

Series line(int colour, bool dashed = false) {
  return {.name = "line " + std::to_string(colour),
          .colour = colour,
          .dashed = dashed,
          .x = {1, 2, 3},
          .y = {1, 2, 3}};
}

TEST(ChartMarks, differ_and_are_more_than_there_are_colours) {
  static_assert(kMarkerCount > kPaletteSize);
  std::set<std::string> marks;
  for (int marker = 0; marker < kMarkerCount; ++marker) marks.insert(mark_data(marker, 50, 60));
  EXPECT_EQ(marks.size(), static_cast<std::size_t>(kMarkerCount));
  EXPECT_EQ(mark_data(kOrange, 50, 60), "M47.0 57.0L53.0 57.0L53.0 63.0L47.0 63.0L47.0 57.0");
}

TEST(ChartMarks, lie_along_the_lines_where_there_are_several) {
  Chart chart{.title = "t", .x_label = "x", .y_label = "y", .series = {line(kOrange)}};
  EXPECT_EQ(testing::occurrences(chart_drawing(chart), "class=\"line c1\""), 1) << "the line alone";
  chart.series.push_back(line(kGreen));
  chart.series.push_back(line(kSky, true));
  const std::string svg = chart_drawing(chart);
  EXPECT_EQ(testing::occurrences(svg, "class=\"line c1\""), 2);
  EXPECT_EQ(testing::occurrences(svg, "class=\"line c2\""), 2);
  EXPECT_EQ(testing::occurrences(svg, "class=\"line c5"), 1) << "dashes tell it apart";
  EXPECT_TRUE(testing::contains(svg, mark_data(kOrange, 78.0, 244.0))) << "at the first point";
  // The legend shows them as well.
  const std::string sign = mark_data(kGreen, kSwatchWidth / 2.0, kSwatchHeight / 2.0);
  EXPECT_TRUE(testing::contains(chart_legend(chart)[1].drawing, sign));
  EXPECT_FALSE(testing::contains(chart_legend(chart)[2].drawing, "c5\" d"));
}

TEST(ChartMarks, of_a_series_may_be_others_than_those_of_its_colour) {
  Series other = line(kBlue);
  other.mark = Mark::kPoints;
  other.marker = kMarkerCount - 1;
  const Chart chart{.title = "t", .x_label = "x", .y_label = "y", .series = {other}};
  const std::string svg = chart_drawing(chart);
  EXPECT_TRUE(testing::contains(svg, mark_data(kMarkerCount - 1, 78.0, 244.0)));
  EXPECT_TRUE(testing::contains(svg, "class=\"line c0\"")) << "strokes, not dots";
  EXPECT_TRUE(testing::contains(chart_legend(chart)[0].drawing, "class=\"line c0\""));
}

TEST(ChartMarks, are_few_on_a_line_of_many_points) {
  Series many{.name = "many", .colour = kSky};
  for (int n = 0; n < 500; ++n) {
    many.x.push_back(n);
    many.y.push_back(1.0);
  }
  const Chart chart{.title = "t", .x_label = "x", .y_label = "y", .series = {many, line(kOrange)}};
  const std::string svg = chart_drawing(chart);
  const std::string marks = svg.substr(svg.rfind("class=\"line c5\""));
  EXPECT_EQ(testing::occurrences(marks.substr(0, marks.find("/>")), "M"), 2 * 8)
      << "two strokes each";
}

}  // namespace chart_marks_test
}  // namespace qsmpc::harness
