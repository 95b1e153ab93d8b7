// Planar obstacles in the plane of position: read, refused with place and reason, written back.
#include "harness/scenario/keys/shape_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace shape_keys_test {

using ::testing::HasSubstr;

// Line 6 is the safe set, line 8 the first obstacle.
std::string with_obstacles(const std::string& lines) {
  return minimal_text + "safe_set:\n  obstacles:\n" + lines;
}

const std::string every_shape = with_obstacles(
    "    - {disc: {centre: [3, 4], radius: 0.5}}\n"
    "    - {ellipse: {centre: [3, -4], semi_axes: [1, 0.5], angle: 0.1}}\n"
    "    - {x: [7, 8], heading: [1, 2]}\n"
    "    - {box: {centre: [9, 5], size: [2, 1], angle: -0.30000000000000004}}\n"
    "    - {polygon: [[10, 0], [11, 0], [10.2, 0.2], [10, 1]]}\n"
    "    - {half_plane: {normal: [0, 2], offset: 30}}\n");

TEST(Shapes, are_read_in_the_order_of_the_scenario) {
  const Scenario scenario = parse_scenario(every_shape);
  const std::vector<controller::Obstacle>& obstacles = scenario.safe_set.obstacles;
  ASSERT_EQ(obstacles.size(), 6U);
  const auto& disc = std::get<controller::DiscShape>(*obstacles[0].shape());
  EXPECT_EQ(disc.centre, Eigen::Vector2d(3, 4));
  EXPECT_EQ(disc.radius, 0.5);
  const auto& ellipse = std::get<controller::EllipseShape>(*obstacles[1].shape());
  EXPECT_EQ(ellipse.semi_axes, Eigen::Vector2d(1, 0.5));
  EXPECT_EQ(ellipse.angle, 0.1);
  EXPECT_EQ(obstacles[2].box()->upper[2], 2.0);
  const auto& box = std::get<controller::TurnedBoxShape>(*obstacles[3].shape());
  EXPECT_EQ(box.size, Eigen::Vector2d(2, 1));
  EXPECT_EQ(box.angle, -0.30000000000000004);
  const auto& polygon = std::get<controller::PolygonShape>(*obstacles[4].shape());
  ASSERT_EQ(polygon.corners.cols(), 4);
  EXPECT_EQ(polygon.corners.col(2), Eigen::Vector2d(10.2, 0.2));
  const auto& half_plane = std::get<controller::HalfPlaneShape>(*obstacles[5].shape());
  EXPECT_EQ(half_plane.normal, Eigen::Vector2d(0, 2));
  EXPECT_EQ(half_plane.offset, 30.0);
  EXPECT_EQ(scenario.safe_set.body.x, 0);
  EXPECT_EQ(scenario.safe_set.body.y, 1);
}

TEST(Shapes, survive_being_written_and_loaded) { expect_round_trip(parse_scenario(every_shape)); }

TEST(Shapes, have_an_angle_of_zero_by_default) {
  const Scenario scenario =
      parse_scenario(with_obstacles("    - {ellipse: {centre: [3, -4], semi_axes: [1, 0.5]}}\n"
                                    "    - {box: {centre: [3, 4], size: [1, 0.5]}}\n"));
  const auto& obstacles = scenario.safe_set.obstacles;
  EXPECT_EQ(std::get<controller::EllipseShape>(*obstacles[0].shape()).angle, 0.0);
  EXPECT_EQ(std::get<controller::TurnedBoxShape>(*obstacles[1].shape()).angle, 0.0);
}

TEST(Shapes, are_changed_by_set) {
  const Scenario scenario = parse_scenario(
      every_shape, {.overrides = {"safe_set.obstacles.0.disc.radius=1",
                                  "safe_set.obstacles.4.polygon.2=[10.5, 0.5]",
                                  "safe_set.obstacles.6={disc: {centre: [0, 9], radius: 2}}"}});
  const auto& obstacles = scenario.safe_set.obstacles;
  ASSERT_EQ(obstacles.size(), 7U);
  EXPECT_EQ(std::get<controller::DiscShape>(*obstacles[0].shape()).radius, 1.0);
  EXPECT_EQ(std::get<controller::PolygonShape>(*obstacles[4].shape()).corners.col(2),
            Eigen::Vector2d(10.5, 0.5));
  EXPECT_EQ(std::get<controller::DiscShape>(*obstacles[6].shape()).centre, Eigen::Vector2d(0, 9));
}

// `obstacle` is at line 8; line 4 is the start and line 5 the target.
struct BrokenShape {
  std::string name;
  std::string obstacle;
  std::string key;       ///< after "safe_set.obstacles.0", unless it begins otherwise
  std::string found;     ///< a piece of it
  std::string expected;  ///< a piece of it
  int line = 8;
};

class BrokenShapes : public ::testing::TestWithParam<BrokenShape> {};

TEST_P(BrokenShapes, are_refused_with_where_and_why) {
  const BrokenShape& broken = GetParam();
  const InputError::Where where = refusal_of(with_obstacles("    - " + broken.obstacle + "\n"));
  EXPECT_EQ(where.file, "t.yaml");
  EXPECT_EQ(where.line, broken.line);
  const bool is_part = broken.key.empty() || broken.key.front() == '.';
  EXPECT_EQ(where.key, (is_part ? "safe_set.obstacles.0" : "") + broken.key);
  EXPECT_THAT(where.found, HasSubstr(broken.found));
  EXPECT_THAT(where.expected, HasSubstr(broken.expected));
}

INSTANTIATE_TEST_SUITE_P(
    Entries, BrokenShapes,
    ::testing::Values(
        BrokenShape{"two_shapes",
                    "{disc: {centre: [9, 9], radius: 1}, box: {centre: [9, 9], size: [1, 1]}}",
                    ".box", "a mapping", "nothing beside disc"},
        BrokenShape{"shape_with_states", "{x: [8, 9], disc: {centre: [9, 9], radius: 1}}", ".x",
                    "a list of 2", "nothing beside disc"},
        BrokenShape{"misspelt_shape", "{dics: {centre: [9, 9], radius: 1}}", ".dics",
                    "an unknown key", "disc (known: x, y, heading, disc, ellipse, box, polygon"},
        BrokenShape{"misspelt_beside_a_shape", "{disc: {centre: [9, 9], radius: 1}, motin: 3}",
                    ".motin", "an unknown key", "motion (known: x, y, heading, disc"},
        BrokenShape{"unknown_beside_a_shape", "{disc: {centre: [9, 9], radius: 1}, colour: 3}",
                    ".colour", "an unknown key", "one of x, y, heading, disc"},
        BrokenShape{"nothing", "{}", "", "fills the whole space", "shapes disc, ellipse, box"},
        BrokenShape{"number_for_a_disc", "{disc: 3}", ".disc", "3", "a mapping"},
        BrokenShape{"misspelt_key", "{disc: {centre: [9, 9], radius: 1, radus: 2}}", ".disc.radus",
                    "an unknown key", "radius (known: centre, radius)"},
        BrokenShape{"no_centre", "{disc: {radius: 1}}", ".disc.centre", "nothing", "[x, y]"},
        BrokenShape{"no_radius", "{disc: {centre: [9, 9]}}", ".disc.radius", "nothing",
                    "a number >= 1e-06"},
        BrokenShape{"radius_of_0", "{disc: {centre: [9, 9], radius: 0}}", ".disc.radius", "0",
                    "a number >= 1e-06"},
        BrokenShape{"negative_radius", "{disc: {centre: [9, 9], radius: -1}}", ".disc.radius", "-1",
                    "a number >= 1e-06"},
        BrokenShape{"radius_in_words", "{disc: {centre: [9, 9], radius: wide}}", ".disc.radius",
                    "wide", "a number"},
        BrokenShape{"centre_of_three", "{disc: {centre: [9, 9, 0], radius: 1}}", ".disc.centre",
                    "a list of 3", "a list of 2 numbers"},
        BrokenShape{"centre_not_finite", "{disc: {centre: [9, .nan], radius: 1}}", ".disc.centre.1",
                    ".nan", "a finite number"},
        BrokenShape{"centre_too_far", "{disc: {centre: [9, 1e300], radius: 1}}", ".disc.centre",
                    "1e+300", "from -1e7 to 1e7"},
        BrokenShape{"flat_ellipse", "{ellipse: {centre: [9, 9], semi_axes: [1, 0]}}",
                    ".ellipse.semi_axes", "[1, 0]", "from 1e-6"},
        BrokenShape{"angle_in_words", "{ellipse: {centre: [9, 9], semi_axes: [1, 1], angle: 45°}}",
                    ".ellipse.angle", "45°", "a number"},
        BrokenShape{"box_of_one_side", "{box: {centre: [9, 9], size: 2}}", ".box.size", "2",
                    "a list of 2 numbers"},
        BrokenShape{"box_without_size", "{box: {centre: [9, 9]}}", ".box.size", "nothing",
                    "two numbers"}),
    [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Polygons, BrokenShapes,
    ::testing::Values(BrokenShape{"two_corners", "{polygon: [[8, 8], [9, 9]]}", ".polygon",
                                  "a list of 2", "3 to 1000 corners"},
                      BrokenShape{"mapping", "{polygon: {corners: [[8, 8], [9, 9], [8, 9]]}}",
                                  ".polygon", "a mapping", "a list"},
                      BrokenShape{"numbers", "{polygon: [8, 8, 9, 9, 8]}", ".polygon",
                                  "a list of 5", "5 rows of 2 numbers"},
                      BrokenShape{"corner_of_three", "{polygon: [[8, 8], [9, 9, 1], [8, 9]]}",
                                  ".polygon.1", "a list of 3", "a row of 2 numbers"},
                      BrokenShape{"word", "{polygon: [[8, 8], [9, far], [8, 9]]}", ".polygon.1.1",
                                  "far", "a finite number"},
                      BrokenShape{"too_far", "{polygon: [[8, 8], [2e7, 9], [8, 9]]}", ".polygon",
                                  "2e+07", "from -1e7 to 1e7"},
                      BrokenShape{"crossing", "{polygon: [[8, 8], [9, 9], [9, 8], [8, 9]]}",
                                  ".polygon", "a list of 4",
                                  "edges that do not meet; those from corners 0 and 2 do"},
                      BrokenShape{"flat", "{polygon: [[8, 8], [9, 9], [10, 10]]}", ".polygon",
                                  "a list of 3", "an area above 0"},
                      BrokenShape{"sliver", "{polygon: [[8, 8], [10, 10], [9, 9.0000000001]]}",
                                  ".polygon", "a list of 3", "an area above 0"},
                      BrokenShape{"closed", "{polygon: [[8, 8], [9, 8], [9, 9], [8, 8]]}",
                                  ".polygon", "a list of 4",
                                  "corners that differ; 3 and 0 are the same"}),
    [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    HalfPlanes, BrokenShapes,
    ::testing::Values(BrokenShape{"no_normal", "{half_plane: {offset: 3}}", ".half_plane.normal",
                                  "nothing", "[x, y]"},
                      BrokenShape{"normal_of_0", "{half_plane: {normal: [0, 0], offset: 3}}",
                                  ".half_plane.normal", "[0, 0]", "a direction"},
                      BrokenShape{"offset_too_far",
                                  "{half_plane: {normal: [0, 1e-3], offset: 1e5}}",
                                  ".half_plane.offset", "1e5", "times the length of the normal"}),
    [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Places, BrokenShapes,
    ::testing::Values(
        BrokenShape{"start_in_a_disc", "{disc: {centre: [0.3, 0], radius: 0.4}}",
                    "initial_state.mean", "inside safe_set.obstacles.0", "the safe set", 4},
        BrokenShape{"target_in_a_half_plane", "{half_plane: {normal: [1, 0], offset: 5}}",
                    "target.state", "inside safe_set.obstacles.0", "the safe set", 5},
        BrokenShape{"target_in_a_polygon", "{polygon: [[4, -1], [6, -1], [5, 0.5], [9, 9]]}",
                    "target.state", "inside safe_set.obstacles.0", "the safe set", 5}),
    [](const auto& tested) { return tested.param.name; });

TEST(Shapes, that_the_body_reaches_into_are_reported) {
  const InputError::Where where =
      refusal_of(with_obstacles("    - {disc: {centre: [0, 1], radius: 0.5}}\n"),
                 {"vehicle.footprint=[{radius: 0.75}]"});
  EXPECT_EQ(where.key, "initial_state.mean");
  EXPECT_THAT(where.found, HasSubstr("a body that reaches 0.25 into safe_set.obstacles.0"));
}

TEST(Shapes, need_a_plane_of_position) {
  const std::string rail =
      "name: rail\nmodel: {system: double_integrator}\nplant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [0, 0]}\ntarget: {state: [5, 0]}\n"
      "safe_set: {obstacles: [{disc: {centre: [3, 0], radius: 1}}]}\n";
  const InputError::Where where = refusal_of(rail);
  EXPECT_EQ(where.line, 6);
  EXPECT_EQ(where.key, "safe_set.obstacles.0.disc");
  EXPECT_THAT(where.expected, HasSubstr("because the system has no position in the plane"));
}

TEST(Shapes, do_not_go_with_the_penalty_of_the_thesis) {
  const InputError::Where where =
      refusal_of(every_shape + "controller:\n  penalty: {shape: thesis}\n");
  EXPECT_EQ(where.line, 15);
  EXPECT_EQ(where.key, "controller.penalty.shape");
  EXPECT_THAT(where.expected, HasSubstr("smooth, because safe_set.obstacles.0 is not a box"));
}

const std::string own_boxes =
    "name: boxes\n"
    "model:\n"
    "  states: {x: m, y: m, box: m, polygon: m}\n"
    "  inputs: {u: {unit: m, bounds: [-1, 1]}}\n"
    "  equations: {x: x + u, y: y, box: box, polygon: polygon}\n"
    "  position: [x, y]\n"
    "plant: {kind: analytic, mjcf: \"\"}\n"
    "initial_state: {mean: [0, 0, 0, 0]}\n"
    "target: {state: [5, 0, 0, 0]}\n";

TEST(Shapes, leave_intervals_to_states_that_are_called_as_they_are) {
  const Scenario scenario = parse_scenario(
      own_boxes +
      "safe_set:\n  obstacles: [{box: [1, 2], polygon: [3, 4]}, {polygon: [[9, 9], [8, 9], [9, "
      "8]]},\n    {box: {centre: [7, 7], size: [1, 1]}}]\n");
  const auto& obstacles = scenario.safe_set.obstacles;
  ASSERT_EQ(obstacles.size(), 3U);
  EXPECT_EQ(obstacles[0].box()->lower[2], 1.0);
  EXPECT_EQ(obstacles[0].box()->upper[3], 4.0);
  EXPECT_NE(obstacles[1].shape(), nullptr);
  EXPECT_NE(obstacles[2].shape(), nullptr);
  expect_round_trip(scenario);
}

TEST(Shapes, are_documented_with_every_key) {
  const std::string text = content_of(std::string(QSMPC_SOURCE_DIR) + "/docs/scenario.md");
  for (const KeyDescription& shape : shape_keys()) {
    EXPECT_THAT(text, HasSubstr("| `" + shape.name + "` |"));
    const MappingValue* mapping = mapping_of(shape);
    if (mapping == nullptr) continue;
    for (const KeyDescription& key : mapping->keys) {
      EXPECT_THAT(text,
                  ::testing::ContainsRegex("\\| `" + shape.name + "` \\|.*`" + key.name + "`"));
    }
  }
}

}  // namespace shape_keys_test
}  // namespace qsmpc::harness
