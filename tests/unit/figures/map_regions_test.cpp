// Obstacles of any outline on a map: polygons and half-planes, clipped to the visible area.
#include "harness/figures/map_regions.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/figures/ground_map.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace map_regions_test {

using testing::contains;
using testing::occurrences;

/// 10 m x 10 m, so that a metre is 48 units: the map is 480 units wide.
constexpr double kUnits = 48.0;
constexpr MapRectangle kSquare{.x_lower = 0, .x_upper = 10, .y_lower = 0, .y_upper = 10};

/// A square of 4 m without its upper right quarter.
const std::vector<MapPoint> kCorner = {{1, 1}, {5, 1}, {5, 3}, {3, 3}, {3, 5}, {1, 5}};

PlaneMap square_map() {
  return {.title = "Map", .x_label = "x (m)", .y_label = "y (m)", .area = kSquare};
}

double area_of(const std::vector<MapPoint>& corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const MapPoint& next = corners[(i + 1) % corners.size()];
    twice += corners[i].x * next.y - next.x * corners[i].y;
  }
  return 0.5 * twice;
}

std::vector<MapPoint> disc(double x, double y, double radius) {
  constexpr int kChords = 72;
  std::vector<MapPoint> corners;
  for (int n = 0; n < kChords; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kChords;
    corners.push_back({.x = x + radius * std::cos(angle), .y = y + radius * std::sin(angle)});
  }
  return corners;
}

/// The corners of the only path with class "obstacle", in metres.
std::vector<MapPoint> drawn_obstacle(const std::string& svg) {
  std::smatch match;
  EXPECT_EQ(occurrences(svg, "<path class=\"obstacle\""), 1);
  if (!std::regex_search(svg, match, std::regex("class=\"obstacle\" d=\"M([-0-9. L]+)Z\""))) {
    return {};
  }
  std::string data = match[1];
  for (char& letter : data) letter = letter == 'L' ? ' ' : letter;
  std::istringstream numbers(data);
  std::vector<MapPoint> corners;
  for (double x = 0.0, y = 0.0; numbers >> x >> y;) {
    corners.push_back({.x = x / kUnits, .y = 10.0 - y / kUnits});
  }
  return corners;
}

TEST(MapRegions, a_polygon_is_cut_to_an_area_whether_it_is_convex_or_not) {
  EXPECT_NEAR(area_of(clipped(kCorner, kSquare)), 12.0, 1e-12);
  // Across both arms: 2 x 1 of one, 1 x 2 of the other, and their intersection.
  const std::vector<MapPoint> part =
      clipped(kCorner, {.x_lower = 2, .x_upper = 4, .y_lower = 2, .y_upper = 4});
  EXPECT_NEAR(area_of(part), 3.0, 1e-12);
  EXPECT_TRUE(
      clipped(kCorner, {.x_lower = 3.5, .x_upper = 9, .y_lower = 3.5, .y_upper = 9}).empty());
  const double far = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(area_of(clipped(kCorner, {-far, 2.0, -far, far})), 4.0, 1e-12);
}

TEST(MapRegions, the_edge_of_a_half_plane_is_nearest_across_it) {
  const MapHalfPlane half_plane{.normal = {.x = 3, .y = 4}, .offset = 50};  // 10 m from the origin
  const MapPoint edge = nearest_on_edge(half_plane, {.x = 0, .y = 0});
  EXPECT_NEAR(edge.x, 6.0, 1e-12);
  EXPECT_NEAR(edge.y, 8.0, 1e-12);
}

TEST(MapFigure, a_polygon_is_drawn_with_its_corners_where_they_belong) {
  PlaneMap map = square_map();
  map.polygons = {{kCorner}};
  const std::string svg = map_drawing(map);
  EXPECT_EQ(testing::tag_problem(svg), "");
  const std::vector<MapPoint> drawn = drawn_obstacle(svg);
  ASSERT_EQ(drawn.size(), kCorner.size());
  EXPECT_NEAR(area_of(drawn), 12.0, 0.01);
  EXPECT_TRUE(contains(svg, "L144.0 336.0L"));  // the corner that leads inwards
}

TEST(MapFigure, a_moving_obstacle_is_a_way_and_outlines_and_has_no_part_in_the_area) {
  PlaneMap map = square_map();
  map.bounds = kSquare;
  map.movers = {{.way = {{1, 1}, {1, 9}},
                 .start = {disc(1, 1, 0.5)},
                 .end = {disc(1, 9, 0.5)},
                 .nearest = {disc(1, 5, 0.5)}},
                {.way = {{2, 1}, {2, 1}}, .start = {disc(2, 1, 0.5)}}};
  const std::string html = map_figure(map);
  EXPECT_EQ(testing::tag_problem(html), "");
  const std::string svg = map_drawing(map);
  EXPECT_EQ(occurrences(svg, "class=\"way faint c0\""), 2);
  EXPECT_TRUE(contains(svg, "d=\"M48.0 432.0L48.0 48.0\""));
  EXPECT_EQ(occurrences(svg, "class=\"outline thin c0\""), 2);
  EXPECT_EQ(occurrences(svg, "class=\"outline thin broken c0\""), 1);
  EXPECT_EQ(occurrences(svg, "class=\"mover c0\""), 1);
  // Each once in the legend.
  EXPECT_EQ(occurrences(html, "moving obstacle at the start</li>"), 1);
  EXPECT_EQ(occurrences(html, "moving obstacle when closest to the vehicle</li>"), 1);
  EXPECT_TRUE(contains(svg_figure({map}), ".mover{fill"));
  EXPECT_FALSE(contains(svg_figure({square_map()}), ".mover{fill"));
  PlaneMap still = map;
  still.movers = {{.start = {disc(2, 1, 0.5)}}};
  EXPECT_FALSE(contains(map_figure(still), "closest to the vehicle"));
  map.area.reset();
  const MapRectangle area = map_area(map);
  map.movers.front().way.push_back({300, 300});
  EXPECT_EQ(map_area(map).x_upper, area.x_upper);
}

TEST(MapFigure, a_disc_takes_no_more_corners_than_can_be_seen) {
  PlaneMap map = square_map();
  map.polygons = {{disc(5, 5, 2)}};
  const std::vector<MapPoint> large = drawn_obstacle(map_drawing(map));
  EXPECT_NEAR(area_of(large), std::numbers::pi * 4.0, 0.03);
  map.polygons = {{disc(5, 5, 0.2)}};
  const std::vector<MapPoint> small = drawn_obstacle(map_drawing(map));
  EXPECT_NEAR(area_of(small), std::numbers::pi * 0.04, 1e-3);
  EXPECT_LT(small.size(), 40U);
  for (const MapPoint& corner : small) {
    EXPECT_NEAR(std::hypot(corner.x - 5.0, corner.y - 5.0), 0.2, 0.1 / kUnits);
  }
  map.polygons.assign(500, {disc(5, 5, 0.2)});
  EXPECT_LT(map_drawing(map).size(), 250'000U);
}

TEST(MapFigure, a_half_plane_is_drawn_to_the_end_of_what_is_shown) {
  PlaneMap map = square_map();
  map.half_planes = {{.normal = {.x = 1, .y = 1}, .offset = 15}};
  const std::vector<MapPoint> drawn = drawn_obstacle(map_drawing(map));
  EXPECT_NEAR(area_of(drawn), 12.5, 0.02);
  map.half_planes = {{.normal = {.x = 1, .y = 1}, .offset = 25}};
  EXPECT_FALSE(contains(map_drawing(map), "<path class=\"obstacle\""));
}

TEST(MapFigure, polygons_and_half_planes_are_content_and_have_the_legend_of_obstacles) {
  PlaneMap map{.title = "Map"};
  map.polygons = {{kCorner}};
  EXPECT_TRUE(has_content(map));
  EXPECT_TRUE(contains(map_figure(map), ">obstacle<"));
  map.polygons.clear();
  map.half_planes = {{.offset = 3.0}};
  EXPECT_TRUE(has_content(map));
  EXPECT_TRUE(contains(map_figure(map), ">obstacle<"));
  map.polygons = {{{{0, 0}, {1, 0}, {std::nan(""), 1}}}};
  EXPECT_FALSE(contains(map_figure(map), "nan"));
}

TEST(MapArea, holds_the_edge_of_a_half_plane_that_is_near) {
  PlaneMap map;
  map.paths = {{.points = {{0, 0}, {10, 10}}}};
  map.half_planes = {{.normal = {.x = 2, .y = 0}, .offset = 26}};
  const MapRectangle near = map_area(map);
  EXPECT_GT(near.x_upper, 13.0);
  EXPECT_LT(near.x_upper, 15.0);
  EXPECT_LT(near.y_upper, 11.0);
  map.half_planes[0].offset = 200;
  EXPECT_LT(map_area(map).x_upper, 11.0);
}

TEST(MapArea, holds_a_polygon) {
  PlaneMap map;
  map.polygons = {{kCorner}};
  const MapRectangle area = map_area(map);
  EXPECT_LT(area.x_lower, 1.0);
  EXPECT_GT(area.x_upper, 5.0);
  EXPECT_LT(area.y_upper, 5.5);
}

TEST(GroundMap, has_boxes_for_what_lies_along_the_axes_and_polygons_for_other_shapes) {
  Scenario scenario = parse_scenario(
      "name: a\nmodel: {system: dubins}\ninitial_state: {mean: [0, 0, 0]}\n"
      "target: {state: [9, 9, 0]}\nsafe_set: {obstacles: [{x: [2, 3], y: [4, 5]}]}\n");
  using controller::PlanarShape;
  std::vector<controller::Obstacle>& obstacles = scenario.safe_set.obstacles;
  obstacles.emplace_back(PlanarShape(controller::TurnedBoxShape{.centre = {5, 5}, .size = {2, 1}}));
  obstacles.emplace_back(
      PlanarShape(controller::TurnedBoxShape{.centre = {5, 5}, .size = {2, 1}, .angle = 0.3}));
  obstacles.emplace_back(PlanarShape(controller::DiscShape{.centre = {1, 7}, .radius = 0.5}));
  obstacles.emplace_back(PlanarShape(controller::HalfPlaneShape{.normal = {0, 2}, .offset = 22}));
  const PlaneMap map = ground_map(scenario, system_of(scenario));
  ASSERT_EQ(map.obstacles.size(), 2U);
  EXPECT_EQ(map.obstacles[0].y_upper, 5.0);
  EXPECT_EQ(map.obstacles[1].x_lower, 4.0);
  EXPECT_EQ(map.obstacles[1].y_upper, 5.5);
  ASSERT_EQ(map.polygons.size(), 2U);
  EXPECT_NEAR(area_of(map.polygons[0].corners), 2.0, 1e-12);
  EXPECT_NEAR(area_of(map.polygons[1].corners), std::numbers::pi / 4.0, 0.002);
  ASSERT_EQ(map.half_planes.size(), 1U);
  EXPECT_EQ(map.half_planes[0].normal.y, 2.0);
  EXPECT_EQ(map.half_planes[0].offset, 22.0);
  EXPECT_LT(map_area(map).y_upper, 13.0);  // of the edge at y = 11
  EXPECT_GT(map_area(map).y_upper, 11.0);
}

}  // namespace map_regions_test
}  // namespace qsmpc::harness
