#include "harness/figures/plane_map.hpp"

#include <cmath>
#include <limits>
#include <regex>

#include <gtest/gtest.h>

#include "harness/figures/palette.hpp"
#include "models/constants.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace plane_map_test {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using testing::contains;
using testing::occurrences;
using testing::tag_problem;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// 10 m x 10 m, so that a metre is 48 units: the map is 480 units wide.
constexpr double kUnits = 48.0;
constexpr MapRectangle kSquare{.x_lower = 0, .x_upper = 10, .y_lower = 0, .y_upper = 10};

PlaneMap square_map() {
  return {.title = "Map", .x_label = "x (m)", .y_label = "y (m)", .area = kSquare};
}

PlaneMap full_map() {
  PlaneMap map = square_map();
  map.note = "A note.";
  map.area.reset();
  map.bounds = {.x_lower = -1, .x_upper = kInfinity, .y_lower = -1, .y_upper = 12};
  map.obstacles = {{.x_lower = 2, .x_upper = 4, .y_lower = 3, .y_upper = kInfinity}};
  map.partial_obstacles = {{.x_lower = 5, .x_upper = 6, .y_lower = 5, .y_upper = 6}};
  map.targets = {{.centre = {.x = 9, .y = 9}, .radius = 0.5}};
  map.contours = {{.name = "density", .colour = kGreen, .lines = {{0.5, Matrix2Xd::Random(2, 9)}}}};
  map.clouds = {{.name = "samples", .colour = kOrange, .points = Matrix2Xd::Random(2, 30)}};
  map.paths = {{.name = "driven",
                .colour = kInk,
                .points = {{0, 0}, {3, 1}, {6, 2}, {9, 9}},
                .start_mark = MapMark::kDot,
                .end_mark = MapMark::kSquare,
                .arrow_period = 2}};
  map.ellipses = {{.name = "belief",
                   .colour = kBlue,
                   .mean = {3, 1},
                   .covariance = Vector2d(1, 2).asDiagonal(),
                   .label = "1 s"}};
  map.labels = {{.text = "start", .at = {.x = 0, .y = 0}}};
  return map;
}

/// The numbers in the groups of the first match of `pattern` in `text`.
std::vector<double> numbers_of(const std::string& text, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(pattern))) return {};
  std::vector<double> numbers;
  for (std::size_t n = 1; n < match.size(); ++n) numbers.push_back(std::stod(match[n]));
  return numbers;
}

const std::string kNumber = "(-?[0-9.]+)";
const std::string kEllipse = "d=\"M" + kNumber + " " + kNumber + "A" + kNumber + " " + kNumber +
                             " " + kNumber + " 0 0 " + kNumber + " " + kNumber;

TEST(MapFigure, has_title_note_labels_legend_and_every_sign) {
  const std::string html = map_figure(full_map());
  EXPECT_EQ(testing::tag_problem(html), "");
  for (const char* text :
       {">Map<", "A note.", ">x (m)<", ">y (m)<", "driven", "samples", "belief", "density",
        "target", "obstacle", "obstacle for some values of the other states",
        "outside of the bounds", "start", "1 s", "Ellipses hold 50 and 95 %.",
        "Lines of equal density hold 50 %."}) {
    EXPECT_TRUE(testing::contains(html, text)) << text;
  }
  for (const char* sign :
       {"class=\"unsafe\"", "class=\"free\"", "class=\"obstacle\"", "class=\"partial\"",
        "class=\"target\"", "class=\"outline c2\"", "class=\"dots c1\"", "class=\"way c6\"",
        "class=\"arrow c6\"", "class=\"outline c0\"", "class=\"mark c6\"",
        "class=\"mark square c6\"", "class=\"time\""}) {
    EXPECT_TRUE(testing::contains(html, sign)) << sign;
  }
}

TEST(MapFigure, axes_are_equal_and_points_are_where_they_belong) {
  PlaneMap map = square_map();
  map.paths = {{.points = {{1, 2}, {4, 6}}}};
  EXPECT_TRUE(testing::contains(map_drawing(map), "d=\"M48.0 384.0L192.0 192.0\""));
}

TEST(MapFigure, a_confidence_ellipse_has_its_axes) {
  // Standard deviations 2 along (3, 4)/5 and 0.5 across; p = 1 − e^(−1/2) is one deviation away.
  const Eigen::Matrix2d turn = (Eigen::Matrix2d() << 0.6, -0.8, 0.8, 0.6).finished();
  PlaneMap map = square_map();
  map.ellipses = {{.mean = {5, 5},
                   .covariance = turn * Vector2d(4, 0.25).asDiagonal() * turn.transpose(),
                   .levels = {1.0 - std::exp(-0.5)}}};
  const std::vector<double> data = numbers_of(map_drawing(map), kEllipse);
  ASSERT_EQ(data.size(), 7U);
  EXPECT_NEAR(data[2], 2.0 * kUnits, 0.01);  // printed digits, also below
  EXPECT_NEAR(data[3], 0.5 * kUnits, 0.01);
  // From one end of the longer axis to the other, in either direction.
  EXPECT_NEAR(std::abs(data[5] - data[0]), 2.0 * 1.2 * kUnits, 0.11);
  EXPECT_NEAR(std::abs(data[6] - data[1]), 2.0 * 1.6 * kUnits, 0.11);
  EXPECT_LT((data[5] - data[0]) * (data[6] - data[1]), 0.0);  // up to the right, y points down
  EXPECT_NEAR(std::remainder(data[4] + std::atan2(4, 3) * 180.0 / M_PI, 180.0), 0.0, 0.06);
}

TEST(MapFigure, an_ellipse_holds_its_part_of_the_normal_distribution) {
  PlaneMap map = square_map();
  map.ellipses = {{.mean = {5, 5}, .covariance = Eigen::Matrix2d::Identity(), .levels = {0.95}}};
  const std::vector<double> data = numbers_of(map_drawing(map), kEllipse);
  ASSERT_EQ(data.size(), 7U);
  EXPECT_NEAR(data[2] / kUnits, std::sqrt(5.991465), 1e-3);  // χ²(2) at 95 %; printed digits
}

TEST(MapFigure, singular_covariances_are_lines_and_dots) {
  PlaneMap map = square_map();
  map.ellipses = {{.colour = kBlue, .mean = {5, 5}, .covariance = Eigen::Matrix2d::Ones()},
                  {.colour = kGreen, .mean = {2, 2}}};
  const std::string svg = map_drawing(map);
  EXPECT_EQ(testing::occurrences(svg, "class=\"outline c0\""), 2);
  EXPECT_FALSE(testing::contains(svg, "A"));
  EXPECT_TRUE(testing::contains(svg, "class=\"outline c2 spot\" d=\"M96.0 384.0h0\""));
}

TEST(MapFigure, the_area_of_a_dot_is_in_proportion_to_its_weight) {
  PlaneMap map = square_map();
  MapCloud cloud{.points = Matrix2Xd::Constant(2, 101, 5.0), .weights = Eigen::VectorXd::Ones(101)};
  cloud.points.col(0) << 1, 1;
  cloud.weights[0] = 4.0;
  map.clouds = {cloud};
  const std::string svg = map_drawing(map);
  const double large =
      numbers_of(svg, "stroke-width=\"" + kNumber + "\" d=\"M48.0 432.0h0\"").at(0);
  const double small = numbers_of(svg, "stroke-width=\"" + kNumber + "\" d=\"M240.0").at(0);
  EXPECT_NEAR(large / small, 2.0, 0.1);  // of the diameters, which come in steps
}

TEST(MapFigure, a_single_heavy_dot_does_not_cover_the_map) {
  PlaneMap map = square_map();
  map.clouds = {{.points = Matrix2Xd::Constant(2, 1, 5.0)}};
  const double diameter = numbers_of(map_drawing(map), "stroke-width=\"" + kNumber + "\"").at(0);
  EXPECT_LE(diameter, 12.0);
}

TEST(MapFigure, a_large_cloud_is_thinned_by_weight_with_a_note) {
  constexpr Index kPoints = 100000;
  PlaneMap map = square_map();
  MapCloud cloud{.points = Matrix2Xd(2, kPoints), .weights = Eigen::VectorXd(kPoints)};
  // Three quarters of the weight are on the left, on one tenth of the points.
  for (Index i = 0; i < kPoints; ++i) {
    const bool left = i % 10 == 0;
    cloud.points.col(i) << (left ? 1.0 : 9.0), 1e-4 * static_cast<double>(i);
    cloud.weights[i] = left ? 27.0 : 1.0;
  }
  map.clouds = {cloud, {.points = Vector2d(5, 5)}};
  const std::string html = map_figure(map);
  EXPECT_LT(html.size(), 200000U);
  EXPECT_TRUE(testing::contains(html, "Of 100001 dots, "));
  const int left = testing::occurrences(html, "M48.0 ");
  const int right = testing::occurrences(html, "M432.0 ");
  EXPECT_GT(left + right, 3000);
  EXPECT_NEAR(static_cast<double>(left) / (left + right), 0.75, 0.01);  // one pick in some hundred
  EXPECT_EQ(testing::occurrences(html, "M240.0 240.0h0"), 1);  // a small cloud keeps all its dots
  EXPECT_EQ(map_figure(map), html);
}

TEST(MapFigure, a_heavy_point_of_a_thinned_cloud_stays_heavy) {
  constexpr Index kPoints = 20000;
  PlaneMap map = square_map();
  map.clouds = {
      {.points = Matrix2Xd::Constant(2, kPoints, 5.0), .weights = Eigen::VectorXd::Ones(kPoints)}};
  map.clouds[0].points.col(kPoints / 2) << 1, 1;
  map.clouds[0].weights[kPoints / 2] = 0.05 * kPoints;
  const std::string svg = map_drawing(map);
  const double heavy =
      numbers_of(svg, "stroke-width=\"" + kNumber + "\" d=\"M48.0 432.0h0\"").at(0);
  EXPECT_GT(heavy, 3.0 * numbers_of(svg, "stroke-width=\"" + kNumber + "\" d=\"M240.0").at(0));
}

TEST(MapFigure, many_long_paths_stay_small) {
  PlaneMap map = square_map();
  MapPath path{.name = "one of many", .faint = true};
  for (int i = 0; i <= 5000; ++i) path.points.push_back({.x = 0.002 * i, .y = 5.0});
  map.paths.assign(40, path);
  const std::string html = map_figure(map);
  EXPECT_LT(html.size(), 200000U);
  EXPECT_EQ(testing::occurrences(html, "L480.0 240.0\""), 40);  // each of them is drawn completely
  EXPECT_EQ(testing::occurrences(html, "one of many"), 1);      // and appears once in the legend
}

TEST(MapFigure, what_is_not_finite_is_left_out_with_a_note) {
  PlaneMap map = full_map();
  map.paths[0].points[1].x = kNan;
  map.paths[0].points[3].y = kInfinity;
  map.clouds[0].points(0, 4) = kNan;
  map.clouds[0].weights = Eigen::VectorXd::Ones(30);
  map.clouds[0].weights[7] = kInfinity;
  map.ellipses.push_back({.name = "broken", .mean = {kNan, 0}});
  map.ellipses.push_back({.name = "broken", .covariance = Eigen::Matrix2d::Constant(kInfinity)});
  map.ellipses[0].levels = {kNan, 0.0, 1.0, 0.5};
  map.targets.push_back({.centre = {.x = 0, .y = 0}, .radius = kNan});
  map.contours[0].lines[0].points(1, 3) = kNan;
  map.contours[0].lines[0].mass = kNan;
  map.labels.push_back({.text = "nowhere", .at = {.x = kNan, .y = 0}});
  map.area = MapRectangle{.x_lower = kNan, .x_upper = 1, .y_lower = 0, .y_upper = 1};
  const std::string html = map_figure(map);
  EXPECT_EQ(testing::tag_problem(html), "");
  EXPECT_TRUE(testing::contains(html, "7 values are not finite and not drawn."));
  for (const char* text : {"nan", "inf", "nowhere", "broken"}) {
    EXPECT_FALSE(testing::contains(html, text)) << text;
  }
}

TEST(MapFigure, a_gap_interrupts_a_path) {
  PlaneMap map = square_map();
  map.paths = {{.points = {{1, 1}, {2, 1}, {kNan, 1}, {3, 1}, {kNan, 1}, {4, 1}, {5, 1}}}};
  EXPECT_TRUE(testing::contains(
      map_drawing(map), "d=\"M48.0 432.0L96.0 432.0M144.0 432.0h0M192.0 432.0L240.0 432.0\""));
}

TEST(MapFigure, without_content_it_says_so) {
  PlaneMap map{.title = "Nothing"};
  EXPECT_FALSE(has_content(map));
  EXPECT_TRUE(testing::contains(map_figure(map), "No finite values to draw."));
  map.paths = {{.name = "path", .points = {{kNan, 0}}}};
  map.clouds = {{.points = Matrix2Xd::Constant(2, 3, kNan)}, {}};
  map.contours = {{}};
  EXPECT_FALSE(has_content(map));
  EXPECT_EQ(testing::tag_problem(map_figure(map)), "");
  EXPECT_EQ(testing::tag_problem(map_drawing(map)), "");
  map.paths[0].points.push_back({.x = 1, .y = 2});
  EXPECT_TRUE(has_content(map));
}

TEST(MapFigure, texts_are_escaped) {
  PlaneMap map = full_map();
  const std::string attack = "\"><script>&";
  map.title = map.note = map.x_label = map.y_label = attack;
  map.paths[0].name = map.clouds[0].name = map.ellipses[0].name = map.contours[0].name = attack;
  map.ellipses[0].label = map.labels[0].text = attack;
  const std::string html = map_figure(map);
  EXPECT_FALSE(testing::contains(html, "<script"));
  EXPECT_FALSE(testing::contains(html, "\"&quot;>"));
  EXPECT_EQ(testing::tag_problem(html), "");
}

TEST(MapFigure, levels_that_differ_stand_in_the_legend) {
  PlaneMap map = full_map();
  map.ellipses.push_back({.name = "other", .mean = {1, 1}, .levels = {0.95, 0.25, 0.95, 0.5}});
  const std::string html = map_figure(map);
  EXPECT_TRUE(testing::contains(html, "belief: 50 and 95 %"));
  EXPECT_TRUE(testing::contains(html, "other: 25, 50 and 95 %"));
  EXPECT_FALSE(testing::contains(html, "Ellipses hold"));
}

TEST(MapArea, holds_all_that_is_drawn) {
  PlaneMap map;
  map.ellipses = {{.mean = {0, 0}, .covariance = Vector2d(1, 4).asDiagonal(), .levels = {0.95}}};
  map.clouds = {{.points = Vector2d(7, 0)}};
  const MapRectangle area = map_area(map);
  const double radius = std::sqrt(-2.0 * std::log(0.05));
  EXPECT_LT(area.x_lower, -radius);
  EXPECT_GT(area.x_upper, 7.0);
  EXPECT_LT(area.y_lower, -2.0 * radius);
  EXPECT_GT(area.y_upper, 2.0 * radius);
  EXPECT_LT(area.y_upper, 2.5 * radius);
}

TEST(MapArea, what_is_far_from_the_bounds_does_not_make_them_small) {
  PlaneMap map;
  map.bounds = {.x_lower = 0, .x_upper = 10, .y_lower = 0, .y_upper = 10};
  map.paths = {{.points = {{5, 5}, {1e9, 5}}}};
  const MapRectangle area = map_area(map);
  EXPECT_LT(area.x_upper, 25.0);
  EXPECT_LT(area.y_upper, 11.0);
}

struct Text {
  double x = 0.0;
  double y = 0.0;
};

/// Positions of the labels' texts.
std::vector<Text> label_places(const std::string& svg) {
  const std::regex pattern("class=\"time\" x=\"" + kNumber + "\" y=\"" + kNumber + "\"");
  std::vector<Text> places;
  for (std::sregex_iterator it(svg.begin(), svg.end(), pattern), end; it != end; ++it) {
    places.push_back({.x = std::stod((*it)[1]), .y = std::stod((*it)[2])});
  }
  return places;
}

TEST(MapLabels, do_not_cover_one_another) {
  PlaneMap map = square_map();
  for (int n = 0; n < 8; ++n) map.labels.push_back({.text = "12.5 s", .at = {.x = 5, .y = 5}});
  const std::vector<Text> places = label_places(map_drawing(map));
  ASSERT_EQ(places.size(), 8U);
  for (std::size_t a = 0; a < places.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_TRUE(std::abs(places[a].y - places[b].y) >= 12.0 ||
                  std::abs(places[a].x - places[b].x) >= 33.0)
          << a << " and " << b;
    }
  }
}

TEST(MapLabels, stay_within_the_map) {
  PlaneMap map = square_map();
  for (const double x : {0.0, 10.0}) {
    for (const double y : {0.0, 10.0}) map.labels.push_back({.text = "corner", .at = {x, y}});
  }
  for (const Text& place : label_places(map_drawing(map))) {
    EXPECT_GE(place.x, 0.0);
    EXPECT_LE(place.x, 480.0 - 33.0);
    EXPECT_GE(place.y, 10.0);
    EXPECT_LE(place.y, 480.0);
  }
}

TEST(MapLabels, of_an_ellipse_stand_outside_of_it) {
  // A wide one, and one that only leaves room at its sides.
  for (const Vector2d& variance : {Vector2d(1.0, 0.1), Vector2d(1.0, 4.0)}) {
    PlaneMap map = square_map();
    map.ellipses = {{.mean = {5, 5},
                     .covariance = variance.asDiagonal(),
                     .levels = {0.5, 0.95},
                     .label = "0.5 s"}};
    const std::vector<Text> places = label_places(map_drawing(map));
    ASSERT_EQ(places.size(), 1U);
    const double radius = std::sqrt(-2.0 * std::log(0.05));
    // Distance from the middle to the nearest corner of the text's box, at least 30 x 12 units in
    // size.
    const double x = std::max({places[0].x - 240.0, 0.0, 240.0 - places[0].x - 30.0});
    const double y = std::max({places[0].y - 10.0 - 240.0, 0.0, 240.0 - places[0].y - 2.0});
    EXPECT_GT((Vector2d(x, y) / kUnits).cwiseQuotient(variance.cwiseSqrt()).norm(), radius);
    EXPECT_GE(places[0].x, 0.0);
    EXPECT_LE(places[0].y, 480.0);
  }
}

}  // namespace plane_map_test
}  // namespace qsmpc::harness
