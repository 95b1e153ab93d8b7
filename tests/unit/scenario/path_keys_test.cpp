// Paths to follow, in the scenario and in separate files, and the roads made from them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/regions/planar/road_walls.hpp"
#include "harness/scenario/path_file.hpp"
#include "harness/scenario/target_course.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace path_keys_test {

using ::testing::HasSubstr;

/// minimal_text with another target in line 5.
std::string with_target(const std::string& target) {
  std::string text = minimal_text;
  const std::string old = "target: {state: [5, 0, 0]}";
  return text.replace(text.find(old), old.size(), "target: " + target);
}

Scenario following(const std::string& target) {
  Scenario scenario = parse_scenario(with_target(target), {.file = "t.yaml"});
  expect_round_trip(scenario);
  return scenario;
}

/// A scenario beside the file path.csv with the contents `text`.
struct PathBeside {
  explicit PathBeside(const std::string& text, const std::string& more = "")
      : path(folder.file("path.csv", text)),
        scenario(folder.file("s.yaml", with_target("{path: path.csv" + more + "}"))) {}

  [[nodiscard]] InputError::Where refusal() const {
    try {
      (void)load_scenario(scenario);
    } catch (const InputError& error) {
      return error.where();
    }
    ADD_FAILURE() << "accepted";
    return {};
  }

  TemporaryFolder folder{};
  std::string path;
  std::string scenario;
};

const std::string kSquare =
    "{path: [[0, 0, 1, 2], [10, 0, 1, 2], [20, 0, 1, 2], [26, 6, 1, 2], [20, 12, 1, 2], "
    "[10, 12, 1, 2], [0, 12, 1, 2], [-6, 6, 1, 2]]";

TEST(PathKeys, a_list_of_points_is_an_open_path) {
  const Scenario scenario = following("{path: [[0, 0], [5, 0], [10, 3]], radius: 0.7}");
  ASSERT_TRUE(scenario.target.course.has_value());
  EXPECT_FALSE(scenario.target.path.closed);
  EXPECT_EQ(scenario.safe_set.road, nullptr) << "without widths";
  EXPECT_EQ(scenario.target.course->begin, 0.0);
  EXPECT_EQ(scenario.target.course->end, scenario.target.course->path->length());
  EXPECT_NEAR(scenario.target.state[0], 10.0, 1e-9) << "the target's state is at the end";
  EXPECT_NEAR(scenario.target.state[1], 3.0, 1e-9);
  EXPECT_EQ(scenario.target.path.speed, scenario.model.parameters.at("speed"));
}

TEST(PathKeys, a_path_that_comes_back_is_closed_and_has_laps) {
  const Scenario scenario = following(kSquare + ", laps: 3}");
  EXPECT_TRUE(scenario.target.path.closed);
  const controller::PathTarget& course = *scenario.target.course;
  EXPECT_NEAR(course.end - course.begin, 3.0 * course.path->length(), 1e-9);
  ASSERT_NE(scenario.safe_set.road, nullptr);
  EXPECT_TRUE(is_on_road(*scenario.safe_set.road, {5.0, 0.5}));
  EXPECT_FALSE(is_on_road(*scenario.safe_set.road, {5.0, 3.0}));
  EXPECT_FALSE(is_on_road(*scenario.safe_set.road, {10.0, 6.0})) << "in the middle";
  EXPECT_FALSE(following(kSquare + ", closed: false}").target.path.closed);
}

TEST(PathKeys, a_last_point_that_repeats_the_first_is_left_out) {
  const Scenario scenario = following("{path: [[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]}");
  EXPECT_TRUE(scenario.target.path.closed);
  EXPECT_EQ(scenario.target.path.rows.rows(), 4);
}

TEST(PathKeys, a_file_takes_commas_semicolons_blanks_comments_and_names) {
  for (const char* text : {"# x_m,y_m,w_tr_right_m,w_tr_left_m\n0,0,2,3\n5,0,2,3\n10,1,2,3\n",
                           "x_m;y_m;right;left\r\n0;0;2;3\r\n5;0;2;3  # a bend\r\n10;1;2;3\r\n",
                           "  0 0\t2 3\n\n5.0  0  2 3\n1e1 1 2 3"}) {
    const PathBeside files(text);
    const Scenario scenario = load_scenario(files.scenario);
    expect_round_trip(scenario);
    Eigen::MatrixXd rows(3, 4);
    rows << 0, 0, 2, 3, 5, 0, 2, 3, 10, 1, 2, 3;
    EXPECT_EQ(scenario.target.path.rows, rows);
    EXPECT_NE(scenario.safe_set.road, nullptr);
  }
}

struct WrongPath {
  std::string text;  ///< of the file
  int line;
  std::string found;
  std::string expected;
};

TEST(PathKeys, errors_in_a_file_are_reported_with_their_line) {
  for (const WrongPath& wrong : std::initializer_list<WrongPath>{
           {"0,0\n5,zero\n", 2, "5,zero", "x, y"},
           {"0,0\n5,0,1\n", 2, "5,0,1", "right width"},
           {"0,0,1,1\n5,0\n", 2, "2 numbers", "4 numbers"},
           {"0,0\n\n0,0\n5,0\n", 3, "again", "another point"},
           {"0,0,1,1\n5,0,1,0\n9,0,1,1\n", 2, "widths 1 and 0", "above 0"},
           {"0,0,1,1\n5,0,-1,1\n9,0,1,1\n", 2, "widths -1 and 1", "above 0"},
           {"# nothing\n", 0, "0 points", "at least 2"},
           {"0,0\n", 1, "1 points", "at least 2"},
           {"0,0\n2e9,0\n", 2, "2e+09", "1e7"}}) {
    SCOPED_TRACE(wrong.text);
    const PathBeside files(wrong.text);
    const InputError::Where where = files.refusal();
    EXPECT_EQ(where.file, files.path);
    EXPECT_EQ(where.line, wrong.line);
    EXPECT_THAT(where.found, HasSubstr(wrong.found));
    EXPECT_THAT(where.expected, HasSubstr(wrong.expected));
  }
}

TEST(PathKeys, impossible_roads_are_reported) {
  const PathBeside wide("0,0,3,3\n10,0,3,3\n13,3,3,3\n10,6,3,3\n0,6,3,3\n");
  EXPECT_THAT(wide.refusal().found, HasSubstr("inner side of a bend"));
  EXPECT_GT(wide.refusal().line, 0);
  std::string eight;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 40;
    eight += fmt::format("{},{},1,1\n", 30.0 * std::sin(angle), 15.0 * std::sin(2.0 * angle));
  }
  EXPECT_THAT(PathBeside(eight).refusal().found, HasSubstr("edges that meet near"));
  // A path without widths may cross itself.
  std::string line;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 40;
    line += fmt::format("{},{}\n", 30.0 * std::sin(angle), 15.0 * std::sin(2.0 * angle));
  }
  EXPECT_TRUE(load_scenario(PathBeside(line).scenario).target.path.closed);
}

TEST(PathKeys, a_road_narrower_than_the_vehicle_is_reported) {
  const InputError::Where where =
      refusal_of(with_target("{path: [[0, 0, 1, 1], [5, 0, 1, 1], [10, 0, 0.3, 0.4]]}") +
                 "vehicle: {footprint: [{radius: 0.5}]}\n");
  EXPECT_EQ(where.line, 5);
  EXPECT_EQ(where.key, "target.path.2");
  EXPECT_THAT(where.found, HasSubstr("0.7 m wide"));
  EXPECT_THAT(where.expected, HasSubstr("more than the 1 m"));
}

TEST(PathKeys, a_start_off_the_road_or_over_its_edge_is_reported) {
  const std::string road = "{path: [[0, 5, 1, 1], [5, 5, 1, 1], [10, 5, 1, 1]]}";
  EXPECT_THAT(refusal_of(with_target(road)).found, HasSubstr("off the road"));
  const std::string near = "{path: [[-5, 0.8, 1, 1], [5, 0.8, 1, 1], [10, 0.8, 1, 1]]}";
  EXPECT_THAT(refusal_of(with_target(near) + "vehicle: {footprint: [{radius: 0.5}]}\n").found,
              HasSubstr("beyond the edge"));
}

TEST(PathKeys, what_does_not_go_with_a_path_is_refused) {
  const std::string path = "{path: [[0, 0], [5, 0]]";
  EXPECT_EQ(refusal_of(with_target(path + ", state: [5, 0, 0]}")).key, "target.state");
  EXPECT_EQ(refusal_of(with_target(path + ", angles: [heading]}")).key, "target.angles");
  EXPECT_EQ(refusal_of(with_target(path + ", laps: 2}")).key, "target.laps");
  EXPECT_EQ(refusal_of(with_target(path + ", speed: 7}")).key, "target.speed");
  EXPECT_EQ(refusal_of(with_target(path + ", speed: fast}")).key, "target.speed");
  EXPECT_EQ(refusal_of(with_target("{state: [5, 0, 0], laps: 2}")).key, "target.laps");
  EXPECT_EQ(refusal_of(with_target("{radius: 1}")).key, "target.state");
  EXPECT_EQ(refusal_of(with_target("{path: gone.csv}")).key, "target.path");
  EXPECT_EQ(refusal_of(with_target("{path: /}")).found, "the folder /");
  EXPECT_EQ(refusal_of(with_target("{path: [[0, 0], [5]]}")).key, "target.path.1");
  EXPECT_EQ(refusal_of(with_target("{path: [[0, 0], 5]}")).key, "target.path.1");
  const auto refused_with = [&](const std::string& controller) {
    return refusal_of(with_target(path + "}") + "controller: " + controller + "\n").key;
  };
  EXPECT_EQ(refused_with("{kind: lqr, lqr: {about: target}}"), "target.path");
  EXPECT_EQ(refused_with("{kind: external, command: [\"true\"]}"), "target.path");
}

TEST(PathKeys, a_bicycle_has_a_given_speed_or_drives_as_fast_as_allowed) {
  const std::string text =
      "name: test\nmodel: {system: bicycle}\nplant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [0, 0, 0, 3, 0, 0]}\n";
  EXPECT_EQ(refusal_of(text + "target: {path: [[0, 0], [9, 0]]}\n").key, "target.speed");
  const Scenario slow =
      parse_scenario(text + "target: {path: [[0, 0], [9, 0]], speed: 4}\n", {.file = "t.yaml"});
  EXPECT_EQ(slow.target.course->speed.at(3.0), 4.0);
  const Scenario fast =
      parse_scenario(text +
                         "target: {path: [[0, 0], [20, 0], [30, 10], [30, 30]], speed: fast, "
                         "acceleration: [1, 2], top_speed: 6}\n",
                     {.file = "t.yaml"});
  expect_round_trip(fast);
  EXPECT_NEAR(fast.target.course->speed.top(), 6.0, 1e-9);
  double least = 6.0;
  for (double along = 0.0; along < 50.0; along += 0.5) {
    least = std::min(least, fast.target.course->speed.at(along));
  }
  EXPECT_LT(least, 5.9) << "in the bend";
}

}  // namespace path_keys_test
}  // namespace qsmpc::harness
