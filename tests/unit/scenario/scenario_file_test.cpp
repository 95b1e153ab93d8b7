// Loading, defaults and writing back.
#include "harness/scenario/scenario_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/shipped_files.hpp"
#include "models/constants.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace scenario_file_test {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ScenarioFile, what_is_left_out_gets_its_documented_default) {
  const Scenario scenario = parse_scenario(minimal_text);
  EXPECT_EQ(scenario.seed, 0U);
  EXPECT_EQ(scenario.time_step, 0.1);
  EXPECT_EQ(scenario.initial_state.covariance, Eigen::MatrixXd::Zero(3, 3));
  EXPECT_EQ(scenario.disturbance.covariance, Eigen::MatrixXd::Zero(3, 3));
  EXPECT_EQ(scenario.disturbance.sensor, Eigen::MatrixXd::Zero(3, 3));
  EXPECT_EQ(scenario.safe_set.bounds.upper[0], kInfinity);
  EXPECT_TRUE(scenario.safe_set.obstacles.empty());
  EXPECT_EQ(scenario.target.radius, 0.5);
  EXPECT_TRUE(scenario.target.angles.empty());
  EXPECT_EQ(scenario.estimator.kind, "exact");
  EXPECT_EQ(scenario.controller.kind, "quantised");
  EXPECT_EQ(scenario.controller.lqr_about, "path");
  EXPECT_EQ(scenario.controller.horizon, 8);
  EXPECT_EQ(scenario.controller.quantisation.quantiser, "product");
  EXPECT_EQ(scenario.controller.propagator, "mixture");
  EXPECT_FALSE(scenario.controller.optimise_gain);
  EXPECT_EQ(scenario.controller.solver, "lbfgs");
  EXPECT_EQ(scenario.controller.input_bounding, "bounded");
  EXPECT_EQ(scenario.controller.deadline, kInfinity);
  EXPECT_EQ(scenario.controller.threads, 1);
  EXPECT_FALSE(scenario.controller.feedback_gain.has_value());
  EXPECT_EQ(scenario.controller.cost.state, Eigen::MatrixXd::Identity(3, 3));
  EXPECT_EQ(scenario.controller.cost.terminal, scenario.controller.cost.state);
  const auto car = models::make_dynamics("dubins", {}, 0.1);
  EXPECT_EQ(scenario.controller.input_lower, car->description().input_lower);
  EXPECT_EQ(scenario.controller.input_upper, car->description().input_upper);
  EXPECT_EQ(scenario.model.parameters, models::systems().front().defaults);
  EXPECT_EQ(scenario.step_limit, 200);
  EXPECT_TRUE(scenario.stop_when_unsafe);
  EXPECT_EQ(scenario.video.width, 1280);
}

constexpr const char* kEveryKey = R"(
name: all
description: every key
seed: 7
model: {system: dubins, speed: 2.5}
plant: {kind: analytic, mjcf: ""}
vehicle: {footprint: [{radius: 0.5, offset: [0.6, 0.7]}]}
time_step: 0.2
initial_state: {mean: [1, 2, 3], covariance: [[2, 1, 0], [1, 2, 0], [0, 0, 1]]}
disturbance: {covariance: [4, 5, 6], sensor: [[7, 0, 0], [0, 8, 1], [0, 1, 9]]}
safe_set:
  bounds: {x: [-10, 11], heading: [-.inf, 9]}
  obstacles: [{y: [-4, -3]}]
target: {state: [4, 5, 6], radius: 0.25, angles: [heading]}
controller:
  horizon: 9
  policy: open_loop
  feedback_gain: [[0.1, 0.2, 0.3]]
  optimise_gain: false
  solver: lbfgs
  input_bounding: penalty
  quantisation: {state: 11, noise: 12, compressed: 13, quantiser: lloyd}
  propagate_noise: false
  propagator: mixture
  cost: {state: [1, 2, 3], input: [[4]], terminal: [5, 6, 7]}
  penalty: {shape: thesis, box: 21, obstacle: 22, length: 23}
  input_bounds: {yaw_rate: [-0.5, 0.75]}
  max_iterations: 31
  deadline: 0.075
  threads: 3
limit: {steps: 32, stop_when_unsafe: false}
video: {camera: fixed, size: 640x360, fps: 24, overlays: [raw, tube]}
)";

TEST(ScenarioFile, every_key_reaches_its_value) {
  const Scenario scenario = parse_scenario(kEveryKey);
  EXPECT_EQ(scenario.name, "all");
  EXPECT_EQ(scenario.description, "every key");
  EXPECT_EQ(scenario.seed, 7U);
  EXPECT_EQ(scenario.model.parameters.at("speed"), 2.5);
  EXPECT_EQ(scenario.plant.kind, "analytic");
  ASSERT_EQ(scenario.safe_set.body.discs.size(), 1U);
  EXPECT_EQ(scenario.safe_set.body.discs[0].radius, 0.5);
  EXPECT_EQ(scenario.safe_set.body.discs[0].offset, Eigen::Vector2d(0.6, 0.7));
  EXPECT_EQ(scenario.plant.mjcf, "");
  EXPECT_EQ(scenario.time_step, 0.2);
  EXPECT_EQ(scenario.initial_state.mean, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scenario.initial_state.covariance(0, 1), 1.0);
  EXPECT_EQ(scenario.disturbance.covariance.diagonal(), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(scenario.disturbance.sensor.diagonal(), Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(scenario.disturbance.sensor(1, 2), 1.0);
  EXPECT_EQ(scenario.safe_set.bounds.lower, Eigen::Vector3d(-10, -kInfinity, -kInfinity));
  EXPECT_EQ(scenario.safe_set.bounds.upper, Eigen::Vector3d(11, kInfinity, 9));
  ASSERT_EQ(scenario.safe_set.obstacles.size(), 1U);
  EXPECT_EQ(scenario.safe_set.obstacles[0].box()->lower,
            Eigen::Vector3d(-kInfinity, -4, -kInfinity));
  EXPECT_EQ(scenario.target.state, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(scenario.target.radius, 0.25);
  EXPECT_EQ(scenario.target.angles, std::vector<int>{2});
  EXPECT_EQ(scenario.step_limit, 32);
  EXPECT_FALSE(scenario.stop_when_unsafe);
  EXPECT_EQ(scenario.video.camera, "fixed");
  EXPECT_EQ(scenario.video.width, 640);
  EXPECT_EQ(scenario.video.height, 360);
  EXPECT_EQ(scenario.video.fps, 24);
  EXPECT_EQ(scenario.video.overlays, (std::vector<std::string>{"raw", "tube"}));
  expect_round_trip(scenario);
}

TEST(ScenarioFile, every_controller_key_reaches_its_value) {
  const Scenario::Controller controller = parse_scenario(kEveryKey).controller;
  EXPECT_EQ(controller.horizon, 9);
  EXPECT_EQ(controller.policy, "open_loop");
  ASSERT_TRUE(controller.feedback_gain.has_value());
  EXPECT_EQ(*controller.feedback_gain, Eigen::RowVector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(controller.quantisation.state, 11);
  EXPECT_EQ(controller.quantisation.noise, 12);
  EXPECT_EQ(controller.quantisation.compressed, 13);
  EXPECT_EQ(controller.quantisation.quantiser, "lloyd");
  EXPECT_FALSE(controller.propagate_noise);
  EXPECT_EQ(controller.cost.state.diagonal(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(controller.cost.input(0, 0), 4.0);
  EXPECT_EQ(controller.cost.terminal.diagonal(), Eigen::Vector3d(5, 6, 7));
  EXPECT_EQ(controller.penalty.shape, "thesis");
  EXPECT_EQ(controller.penalty.box, 21.0);
  EXPECT_EQ(controller.penalty.obstacle, 22.0);
  EXPECT_EQ(controller.penalty.length, 23.0);
  EXPECT_EQ(controller.input_lower[0], -0.5);
  EXPECT_EQ(controller.input_upper[0], 0.75);
  EXPECT_EQ(controller.input_bounding, "penalty");
  EXPECT_EQ(controller.max_iterations, 31);
  EXPECT_EQ(controller.deadline, 0.075);
  EXPECT_EQ(controller.threads, 3);
}

TEST(ScenarioFile, every_shipped_scenario_is_valid_and_named_like_its_file) {
  const std::vector<ShippedScenario> shipped = shipped_scenarios();
  EXPECT_GE(shipped.size(), 3U);
  for (const ShippedScenario& entry : shipped) {
    SCOPED_TRACE(entry.path);
    EXPECT_TRUE(validate_scenario_file(entry.path).empty());
    EXPECT_EQ(load_scenario(entry.name).name, entry.name);
    EXPECT_NE(entry.description, "");
    EXPECT_EQ(content_of(entry.path).front(), '#');
  }
}

TEST(ScenarioFile, every_shipped_scenario_survives_being_written_and_loaded) {
  for (const ShippedScenario& entry : shipped_scenarios()) {
    const Scenario scenario = load_scenario(entry.name);
    expect_round_trip(scenario);
    EXPECT_THAT(to_yaml(scenario), Not(HasSubstr(shipped_models_folder())));
  }
}

TEST(ScenarioFile, awkward_values_survive_being_written_and_loaded) {
  expect_round_trip(minimal_with({
      "name='a \"quoted\" \\ name: # {not} [yaml] \xC3\xA9'",
      "description='null'",
      "seed=18446744073709551615",
      "time_step=0.30000000000000004",
      "initial_state.mean=[5e-324, -0, 0.1]",
      "initial_state.covariance=[[2, 1, 0], [1, 2, 0.1], [0, 0.1, 3.3333333333333335]]",
      "disturbance.covariance=[1e300, 1e-300, 1.0000000000000002e-300]",
      "safe_set.bounds.x=[-.inf, 1.7976931348623157e308]",
      "safe_set.obstacles=[{heading: [-3, -2.9999999999999996]}, {x: [7, .inf], y: [2, 3]}]",
      "controller.feedback_gain=[0.1, 0.2, -0.3]",
      "controller.input_bounds.yaw_rate=[-0.1, 0.7]",
      "controller.penalty={shape: thesis, box: 0, obstacle: 1e-5, length: 12345678.9}",
      "controller.propagate_noise=false",
      "limit={steps: 7, stop_when_unsafe: false}",
      "video={camera: split, size: 64x4320, fps: 240, overlays: []}",
  }));
}

TEST(ScenarioFile, an_xml_file_beside_the_scenario_is_found_and_written_by_its_path) {
  const TemporaryFolder folder;
  const std::string xml = folder.file("own_car.xml", "<mujoco/>");
  const std::string path = folder.file("s.yaml", minimal_text);
  const Scenario scenario =
      load_scenario(path, {"plant={kind: mujoco, mjcf: own_car.xml}", "vehicle.footprint=point"});
  EXPECT_TRUE(std::filesystem::equivalent(scenario.plant.mjcf, xml));
  EXPECT_TRUE(std::filesystem::path(scenario.plant.mjcf).is_absolute());
  expect_round_trip(scenario);
}

TEST(ScenarioFile, a_recorded_scenario_can_be_read_without_its_xml_file) {
  const std::string text = minimal_text + "video: {fps: 30}\n";
  const std::vector<std::string> elsewhere{"plant={kind: mujoco, mjcf: /elsewhere/car.xml}"};
  const Scenario scenario =
      parse_scenario(text, {.overrides = elsewhere, .files_must_exist = false});
  EXPECT_EQ(scenario.plant.mjcf, "/elsewhere/car.xml");
  EXPECT_THROW((void)parse_scenario(text, {.overrides = elsewhere}), InputError);
}

TEST(ScenarioFile, windows_line_ends_and_a_byte_order_mark_are_read) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : minimal_text) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(parse_scenario(text).name, "test");
  EXPECT_EQ(refusal_of(text + "sed: 3\r\n").line, 6);
}

TEST(ScenarioFile, a_folded_description_is_one_line) {
  EXPECT_EQ(parse_scenario(minimal_text + "description: >\n  two\n  lines\n").description,
            "two lines");
}

TEST(ScenarioFile, a_file_that_cannot_be_read_is_refused_as_a_wrong_input) {
  const TemporaryFolder folder;
  EXPECT_THAT(validate_scenario_file(folder.path()).at(0).found, HasSubstr("a folder"));
  EXPECT_THAT(validate_scenario_file(folder / "none.yaml").at(0).found, HasSubstr("No such file"));
  EXPECT_THAT(validate_scenario_file("/dev/zero").at(0).found, HasSubstr("a device"));
  EXPECT_THAT(validate_scenario_file(folder.file("empty.yaml", "")).at(0).found,
              HasSubstr("an empty text"));
  EXPECT_THROW((void)load_scenario(folder / "none.yaml"), InputError);
}

TEST(ScenarioFile, an_unknown_name_is_answered_with_the_nearest_shipped_one) {
  try {
    (void)load_scenario("dubins_obstacle");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file, "dubins_obstacle");
    EXPECT_THAT(error.where().expected, HasSubstr("dubins_obstacles (known:"));
  }
}

TEST(ScenarioFile, validation_collects_all_problems_in_the_order_of_their_lines) {
  const TemporaryFolder folder;
  const std::string path = folder.file(
      "s.yaml", minimal_text + "video: {fps: 0, camera: x}\nlimit: {steps: no}\nsedd: 1\n");
  std::vector<std::string> keys;
  std::vector<int> lines;
  for (const InputError::Where& where : validate_scenario_file(path)) {
    EXPECT_EQ(where.file, path);
    keys.push_back(where.key);
    lines.push_back(where.line);
  }
  EXPECT_THAT(keys, ::testing::ElementsAre("video.camera", "video.fps", "limit.steps", "sedd"));
  EXPECT_THAT(lines, ::testing::ElementsAre(6, 6, 7, 8));
}

}  // namespace scenario_file_test
}  // namespace qsmpc::harness
