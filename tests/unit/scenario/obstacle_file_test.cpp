// Obstacles in separate files: lists as in the scenario, and GeoJSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/obstacle_reader.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace obstacle_file_test {

using ::testing::HasSubstr;

const std::string from_shapes = minimal_text + "safe_set:\n  obstacles_from_file: shapes.json\n";

// A scenario beside the file shapes.json with the contents `text`.
struct FileBeside {
  explicit FileBeside(const std::string& text)
      : shapes(folder.file("shapes.json", text)), scenario(folder.file("s.yaml", from_shapes)) {}

  TemporaryFolder folder{};
  std::string shapes;
  std::string scenario;
};

std::vector<controller::Obstacle> obstacles_of(const std::string& text) {
  const FileBeside files(text);
  const Scenario scenario = load_scenario(files.scenario);
  expect_round_trip(scenario);
  return scenario.safe_set.obstacles;
}

Eigen::Matrix2Xd corners_of(const controller::Obstacle& obstacle) {
  return std::get<controller::PolygonShape>(*obstacle.shape()).corners;
}

TEST(ObstacleFile, is_a_list_as_the_scenario_has_it) {
  const auto obstacles =
      obstacles_of("- {x: [7, 8]}\n- {disc: {centre: [0, 4], radius: 0.5}}  # a pillar\n");
  ASSERT_EQ(obstacles.size(), 2U);
  EXPECT_EQ(obstacles[0].box()->lower[0], 7.0);
  EXPECT_EQ(std::get<controller::DiscShape>(*obstacles[1].shape()).radius, 0.5);
}

TEST(ObstacleFile, is_a_list_in_json) {
  const auto obstacles =
      obstacles_of("[\n\t{\"polygon\":[[7,0],[8,0],[8,1]]},\n\t{\"x\":[9,10]}\n]\n");
  ASSERT_EQ(obstacles.size(), 2U);
  EXPECT_EQ(corners_of(obstacles[0]).col(2), Eigen::Vector2d(8, 1));
}

TEST(ObstacleFile, is_a_collection_of_geojson) {
  const auto obstacles = obstacles_of(R"({
	"type": "FeatureCollection",
	"name": "yard", "crs": {"type": "name", "properties": {"name": "local"}},
	"features": [
		{"type": "Feature", "id": 1, "properties": {"kind": "wall"}, "geometry": {
			"type": "Polygon", "coordinates": [[[7, 0], [8, 0], [8, 1], [7, 0]]]}},
		{"type": "Feature", "properties": null, "geometry": {"type": "MultiPolygon", "coordinates": [
			[[[7, 3, 0.5], [8, 3, 0.5], [8, 4, 0.5]]],
			[[[7, 5], [8, 6], [8, 5], [7, 5]]]]}},
		{"type": "Feature", "properties": {"radius": 0.25}, "geometry":
			{"type": "Point", "coordinates": [0, 4]}},
		{"type": "Feature", "properties": {}, "geometry": {"type": "GeometryCollection", "geometries": [
			{"type": "Polygon", "coordinates": [[[9, 0], [9.5, 0], [9.5, 1]]]}]}}
	]
}
)");
  ASSERT_EQ(obstacles.size(), 5U);
  EXPECT_EQ(corners_of(obstacles[0]).cols(), 3) << "the last corner of a closed ring is its first";
  EXPECT_EQ(corners_of(obstacles[1]).col(2), Eigen::Vector2d(8, 4));
  EXPECT_EQ(corners_of(obstacles[2]).col(1), Eigen::Vector2d(8, 6));
  const auto& disc = std::get<controller::DiscShape>(*obstacles[3].shape());
  EXPECT_EQ(disc.centre, Eigen::Vector2d(0, 4));
  EXPECT_EQ(disc.radius, 0.25);
  EXPECT_EQ(corners_of(obstacles[4])(0, 1), 9.5);
}

TEST(ObstacleFile, is_a_single_geometry) {
  EXPECT_EQ(
      obstacles_of("{\"type\": \"Polygon\", \"coordinates\": [[[7, 0], [8, 0], [8, 1]]]}").size(),
      1U);
}

TEST(ObstacleFile, comes_after_the_obstacles_of_the_scenario) {
  const FileBeside files("[{x: [7, 8]}]");
  const Scenario scenario =
      load_scenario(files.scenario, {"safe_set.obstacles=[{y: [3, 4]}, {y: [5, 6]}]"});
  ASSERT_EQ(scenario.safe_set.obstacles.size(), 3U);
  EXPECT_EQ(scenario.safe_set.obstacles[2].box()->lower[0], 7.0);
}

TEST(ObstacleFile, is_not_needed_for_the_resolved_scenario) {
  std::string resolved;
  {
    const FileBeside files("[{disc: {centre: [0, 4], radius: 0.5}}]");
    resolved = to_yaml(load_scenario(files.scenario));
  }
  EXPECT_THAT(resolved, HasSubstr("- {disc: {centre: [0, 4], radius: 0.5}}"));
  EXPECT_EQ(parse_scenario(resolved).safe_set.obstacles.size(), 1U);
}

TEST(ObstacleFile, counts_towards_the_most_that_there_may_be) {
  std::string text = "[";
  for (std::size_t i = 0; i < kMostObstacles; ++i) text += "{x: [7, 8]},\n";
  const FileBeside files(text + "]");
  EXPECT_EQ(load_scenario(files.scenario).safe_set.obstacles.size(), kMostObstacles);
  const auto problems =
      validate_scenario_file(files.scenario, {"safe_set.obstacles=[{y: [3, 4]}]"});
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].file, files.shapes);
  EXPECT_EQ(problems[0].found, "a list of 1000");
  EXPECT_THAT(problems[0].expected, HasSubstr("at most 999 obstacles, besides"));
}

struct BrokenFile {
  std::string name;
  std::string text;
  int line;
  std::string key;
  std::string found;     ///< a piece of it
  std::string expected;  ///< a piece of it
};

class BrokenObstacleFile : public ::testing::TestWithParam<BrokenFile> {};

TEST_P(BrokenObstacleFile, is_refused_with_where_and_why) {
  const BrokenFile& broken = GetParam();
  const FileBeside files(broken.text);
  const auto problems = validate_scenario_file(files.scenario);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems[0].file, files.shapes);
  EXPECT_EQ(problems[0].line, broken.line);
  EXPECT_EQ(problems[0].key, broken.key);
  EXPECT_THAT(problems[0].found, HasSubstr(broken.found));
  EXPECT_THAT(problems[0].expected, HasSubstr(broken.expected));
}

INSTANTIATE_TEST_SUITE_P(
    Files, BrokenObstacleFile,
    ::testing::Values(
        BrokenFile{"not_yaml", "[1, 2\n}", 2, "", "not YAML", "YAML"},
        BrokenFile{"text", "walls", 1, "", "walls", "a list of obstacles, or GeoJSON"},
        BrokenFile{"mapping", "{disc: {centre: [0, 4], radius: 1}}", 1, "", "a mapping",
                   "a list of obstacles, or GeoJSON"},
        BrokenFile{"broken_entry", "- {x: [7, 8]}\n- {disc: {centre: [0, 4], radius: -1}}\n", 2,
                   "obstacles.1.disc.radius", "-1", "a number >= 1e-06"},
        BrokenFile{"unknown_type", "{type: Polygn, coordinates: []}", 1, "type", "Polygn",
                   "Polygon (known: FeatureCollection"},
        BrokenFile{"line_string",
                   "type: FeatureCollection\nfeatures:\n- type: Feature\n  geometry:\n"
                   "    type: LineString\n    coordinates: [[0, 0], [1, 1]]\n",
                   5, "features.0.geometry.type", "LineString", "Polygon, MultiPolygon, Point"},
        BrokenFile{"no_feature", "{type: FeatureCollection, features: []}", 1, "features",
                   "an empty list", "at least one"},
        BrokenFile{"no_obstacle", "[]", 1, "", "an empty list", "at least one obstacle"},
        BrokenFile{"no_geometry", "{type: Feature, properties: {}}", 1, "geometry", "nothing",
                   "a geometry"},
        BrokenFile{"no_coordinates", "{type: Polygon}", 1, "coordinates", "nothing", "a list"},
        BrokenFile{"hole",
                   "type: Polygon\ncoordinates:\n- [[0, 4], [9, 4], [9, 9], [0, 4]]\n"
                   "- [[5, 5], [6, 5], [6, 6], [5, 5]]\n",
                   4, "coordinates.1", "a hole", "cut a polygon with a hole"},
        BrokenFile{"crossing", "{type: Polygon, coordinates: [[[8, 8], [9, 9], [9, 8], [8, 9]]]}",
                   1, "coordinates.0", "a list of 4", "edges that do not meet"},
        BrokenFile{"two_corners", "{type: Polygon, coordinates: [[[8, 8], [9, 9], [8, 8]]]}", 1,
                   "coordinates.0", "2 corners", "3 to 1000 corners"},
        BrokenFile{"degrees", "{type: Polygon, coordinates: [[[8, 8], [9, N9], [9, 8]]]}", 1,
                   "coordinates.0.1.1", "N9", "in metres"},
        BrokenFile{"one_number", "{type: Polygon, coordinates: [[[8], [9, 9], [9, 8]]]}", 1,
                   "coordinates.0.0", "a list of 1", "a position"},
        BrokenFile{"point", "{type: Point, coordinates: [8, 8]}", 1, "coordinates",
                   "a Point without a radius", "a Feature whose properties have a radius"},
        BrokenFile{"radius_of_0",
                   "{type: Feature, properties: {radius: 0}, geometry: {type: Point,\n"
                   "coordinates: [8, 8]}}",
                   1, "geometry.coordinates", "the radius 0", "a number from 1e-6"}),
    [](const auto& tested) { return tested.param.name; });

TEST(ObstacleFile, that_does_not_exist_is_refused_at_the_key) {
  const TemporaryFolder folder;
  const auto problems = validate_scenario_file(folder.file("s.yaml", from_shapes));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].line, 7);
  EXPECT_EQ(problems[0].key, "safe_set.obstacles_from_file");
  EXPECT_EQ(problems[0].found, "no file shapes.json");
}

TEST(ObstacleFile, of_geojson_needs_a_plane_of_position) {
  const TemporaryFolder folder;
  const std::string shapes =
      folder.file("shapes.json", "{type: Polygon, coordinates: [[[8, 8], [9, 9], [9, 8]]]}");
  const std::string rail =
      "name: rail\nmodel: {system: double_integrator}\nplant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [0, 0]}\ntarget: {state: [5, 0]}\n";
  const InputError::Where where = refusal_of(rail, {"safe_set.obstacles_from_file=" + shapes});
  EXPECT_EQ(where.file, shapes);
  EXPECT_THAT(where.expected, HasSubstr("no position in the plane"));
}

}  // namespace obstacle_file_test
}  // namespace qsmpc::harness
