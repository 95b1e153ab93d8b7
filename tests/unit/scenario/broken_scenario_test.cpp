// Every error in a scenario is reported with file, line, key, found and expected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace broken_scenario_test {

using ::testing::HasSubstr;

struct Broken {
  std::string name;
  std::string text;
  int line;
  std::string key;
  std::string found;     ///< a piece of it
  std::string expected;  ///< a piece of it
};

// `more` follows the five lines of minimal_text, starting at line 6.
Broken after_minimal(std::string name, const std::string& more, int line, std::string key,
                     std::string found, std::string expected) {
  return {std::move(name), minimal_text + more, line,
          std::move(key),  std::move(found),    std::move(expected)};
}

// Replaces the first `from` in minimal_text.
std::string minimal_with(const std::string& from, const std::string& to) {
  std::string text = minimal_text;
  return text.replace(text.find(from), from.size(), to);
}

class BrokenScenario : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenScenario, is_refused_with_where_and_why) {
  const Broken& broken = GetParam();
  const InputError::Where where = refusal_of(broken.text);
  EXPECT_EQ(where.file, "t.yaml");
  EXPECT_EQ(where.line, broken.line);
  EXPECT_EQ(where.key, broken.key);
  EXPECT_THAT(where.found, HasSubstr(broken.found));
  EXPECT_THAT(where.expected, HasSubstr(broken.expected));
}

std::string name_of(const ::testing::TestParamInfo<Broken>& info) { return info.param.name; }

const std::string limit_twice = "limit: {steps: 3}\nlimit: {steps: 4}\n";
const std::string fifteen_items = ".0.0.0.0.0.0.0.0.0.0.0.0.0.0.0";
const std::string seventeen_levels = "video: " + std::string(17, '[') + std::string(17, ']') + "\n";

INSTANTIATE_TEST_SUITE_P(
    Text, BrokenScenario,
    ::testing::Values(
        Broken{"empty", "", 0, "", "an empty text", "YAML"},
        Broken{"only_a_comment", "# nothing\n", 0, "", "an empty text", "YAML"},
        Broken{"only_a_null", "--- ~\n", 1, "", "nothing", "a mapping"},
        Broken{"plain_words", "hello there\n", 1, "", "hello there", "a mapping"},
        Broken{"a_list", "- 1\n- 2\n", 1, "", "a list of 2", "a mapping"},
        Broken{"not_yaml", "name: [1, 2\nmodel: }\n", 2, "", "not YAML", "YAML"},
        Broken{"not_utf8", "name: a\nseed: \xFF\n", 2, "", "0xFF", "UTF-8"},
        Broken{"overlong_utf8", "name: \xC0\xAF\n", 1, "", "0xC0", "UTF-8"},
        Broken{"surrogate", "name: \xED\xA0\x80\n", 1, "", "0xED", "UTF-8"},
        Broken{"cut_utf8", "name: \xE2\x82", 1, "", "0xE2", "UTF-8"},
        Broken{"control_character", std::string("name: a\0b\n", 10), 1, "", "0x00", "UTF-8"},
        Broken{"lone_carriage_return", "name: a\rb\n", 1, "", "0x0D", "UTF-8"},
        Broken{"two_documents", "name: a\n---\nname: b\n", 2, "", "a second document", "one"},
        after_minimal("anchor", "limit: &a {steps: 3}\n", 6, "limit", "an anchor", "plain values"),
        after_minimal("alias", "limit: *a\n", 6, "", "not YAML", "YAML"),
        after_minimal("tag", "seed: !!int 3\n", 6, "seed", "the tag", "without tags"),
        after_minimal("structured_key", "? [a, b]\n: 1\n", 6, "", "as a key", "a name"),
        after_minimal("duplicate_key", limit_twice, 7, "limit", "second time", "each key once"),
        after_minimal("deep_nesting", seventeen_levels, 6, "video" + fifteen_items,
                      "deeper nesting", "16 levels")),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Keys, BrokenScenario,
    ::testing::Values(
        after_minimal("unknown_section", "contoller:\n  horizon: 3\n", 6, "contoller",
                      "an unknown key", "controller (known: name"),
        after_minimal("unknown_key", "controller:\n  horzon: 3\n", 7, "controller.horzon",
                      "an unknown key", "horizon (known: kind, lqr, mppi, command"),
        after_minimal("unknown_far_key", "video: {zzzzzz: 3}\n", 6, "video.zzzzzz",
                      "an unknown key", "one of camera, size, fps, overlays"),
        after_minimal("unknown_state", "safe_set: {bounds: {z: [0, 1]}}\n", 6, "safe_set.bounds.z",
                      "an unknown key", "one of x, y, heading"),
        after_minimal("unknown_input", "controller: {input_bounds: {yawrate: [0, 1]}}\n", 6,
                      "controller.input_bounds.yawrate", "an unknown key", "yaw_rate"),
        Broken{"unknown_parameter", minimal_with("dubins}", "dubins, sped: 2}"), 2, "model.sped",
               "an unknown key", "speed"},
        Broken{"unknown_system", minimal_with("dubins}", "dubbins}"), 2, "model.system", "dubbins",
               "dubins"},
        Broken{"missing_name", minimal_with("name: test\n", ""), 1, "name", "nothing", "a name"},
        Broken{"empty_name", minimal_with("test", "\"\""), 1, "name", "\"\"", "not empty"},
        Broken{"missing_system", minimal_with("{system: dubins}", "{}"), 2, "model.system",
               "nothing", "dubins"},
        Broken{"missing_model", minimal_with("model: {system: dubins}\n", ""), 1, "model.system",
               "nothing", "dubins"},
        Broken{"missing_mean", minimal_with("{mean: [0, 0, 0]}", "{}"), 4, "initial_state.mean",
               "nothing", "3 numbers, [x, y, heading]"},
        Broken{"missing_target", minimal_with("target: {state: [5, 0, 0]}\n", ""), 1,
               "target.state", "nothing", "3 numbers"},
        Broken{"section_is_a_number", minimal_with("{kind: analytic, mjcf: \"\"}", "3"), 3, "plant",
               "3", "a mapping"},
        Broken{"section_is_empty", minimal_with("{kind: analytic, mjcf: \"\"}", ""), 3, "plant",
               "nothing", "a mapping"},
        after_minimal("unknown_policy", "controller: {policy: closed_lop}\n", 6,
                      "controller.policy", "closed_lop", "closed_loop (known"),
        after_minimal("unknown_solver", "controller: {solver: lbfg}\n", 6, "controller.solver",
                      "lbfg", "lbfgs"),
        after_minimal("unknown_bounding", "controller:\n  input_bounding: sigmod\n", 7,
                      "controller.input_bounding", "sigmod",
                      "sigmoid (known: bounded, sigmoid, tanh, penalty)"),
        after_minimal("bounding_of_another_solver",
                      "controller:\n  solver: slsqp\n  input_bounding: tanh\n", 8,
                      "controller.input_bounding", "tanh", "bounded, or controller.solver: lbfgs"),
        after_minimal("gain_of_no_feedback",
                      "controller:\n  policy: open_loop\n  optimise_gain: true\n", 8,
                      "controller.optimise_gain", "true",
                      "false, or controller.policy: closed_loop"),
        after_minimal("unknown_propagator", "controller:\n  propagator: moment_match\n", 7,
                      "controller.propagator", "moment_match",
                      "moment_matched (known: mixture, compressed, moment_matched, soft)"),
        after_minimal("propagator_without_noise", "controller: {propagator: noise_free}\n", 6,
                      "controller.propagator", "noise_free",
                      "one of mixture, compressed, moment_matched, soft"),
        after_minimal("propagator_of_no_noise",
                      "controller:\n  propagate_noise: false\n  propagator: soft\n", 8,
                      "controller.propagator", "soft",
                      "mixture, or controller.propagate_noise: true"),
        after_minimal("unknown_quantiser", "controller: {quantisation: {quantiser: loyd}}\n", 6,
                      "controller.quantisation.quantiser", "loyd", "lloyd (known: product, lloyd)"),
        after_minimal("unknown_shape", "controller: {penalty: {shape: smoth}}\n", 6,
                      "controller.penalty.shape", "smoth", "smooth"),
        after_minimal("unknown_camera", "video: {camera: birdseye}\n", 6, "video.camera",
                      "birdseye", "one of chase, fixed, split, top"),
        after_minimal("unknown_overlay", "video: {overlays: [tube, elipses]}\n", 6,
                      "video.overlays", "elipses", "ellipses (known: particles, ellipses, tube"),
        after_minimal("overlay_twice", "video: {overlays: [raw, raw]}\n", 6, "video.overlays",
                      "raw a second time", "each overlay once"),
        Broken{"unknown_plant", minimal_with("analytic", "mujco"), 3, "plant.kind", "mujco",
               "mujoco"},
        Broken{"missing_xml",
               minimal_with("analytic, mjcf: \"\"}", "mujoco, mjcf: no_such_car.xml}"), 3,
               "plant.mjcf", "no file no_such_car.xml", "a file beside the scenario"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Values, BrokenScenario,
    ::testing::Values(
        after_minimal("text_for_number", "time_step: fast\n", 6, "time_step", "fast", "a number"),
        after_minimal("quoted_number", "time_step: \"0.1\"\n", 6, "time_step", "\"0.1\"",
                      "a number"),
        after_minimal("number_with_unit", "time_step: 0.1s\n", 6, "time_step", "0.1s", "a number"),
        after_minimal("nan", "time_step: .nan\n", 6, "time_step", ".nan", "a number"),
        after_minimal("infinity_word", "time_step: infinity\n", 6, "time_step", "infinity",
                      "a number"),
        after_minimal("overflow", "controller: {penalty: {box: 1e999}}\n", 6,
                      "controller.penalty.box", "1e999", "a number >= 0"),
        after_minimal("list_for_number", "time_step: [0.1]\n", 6, "time_step", "a list of 1",
                      "a number"),
        after_minimal("no_time_step", "time_step: 0\n", 6, "time_step", "0", ">= 0.0001"),
        after_minimal("negative_time_step", "time_step: -0.1\n", 6, "time_step", "-0.1", ">="),
        after_minimal("no_steps", "limit: {steps: 0}\n", 6, "limit.steps", "0", "from 1"),
        after_minimal("fraction_of_a_step", "limit: {steps: 1.5}\n", 6, "limit.steps", "1.5",
                      "a whole number"),
        after_minimal("word_for_flag", "limit: {stop_when_unsafe: maybe}\n", 6,
                      "limit.stop_when_unsafe", "maybe", "true or false"),
        after_minimal("negative_seed", "seed: -1\n", 6, "seed", "-1", "a whole number from 0"),
        after_minimal("seed_too_large", "seed: 18446744073709551616\n", 6, "seed", "1844",
                      "from 0"),
        after_minimal("horizon_0", "controller: {horizon: 0}\n", 6, "controller.horizon", "0",
                      "a whole number from 1 to 1000"),
        after_minimal("horizon_1001", "controller: {horizon: 1001}\n", 6, "controller.horizon",
                      "1001", "from 1 to 1000"),
        after_minimal("unknown_points", "controller: {quantisation: automatic}\n", 6,
                      "controller.quantisation", "automatic", "auto, or a mapping"),
        after_minimal("list_of_points", "controller: {quantisation: [100]}\n", 6,
                      "controller.quantisation", "a list of 1", "auto, or a mapping"),
        after_minimal("negative_tolerance", "controller: {quantisation: {tolerance: -0.1}}\n", 6,
                      "controller.quantisation.tolerance", "-0.1", "a number >= 0 and <= 1"),
        after_minimal("no_points", "controller: {quantisation: {noise: 0}}\n", 6,
                      "controller.quantisation.noise", "0", "from 1 to 100000"),
        after_minimal("too_many_points", "controller: {quantisation: {state: 100001}}\n", 6,
                      "controller.quantisation.state", "100001", "from 1 to 100000"),
        after_minimal("no_iterations", "controller: {max_iterations: 0}\n", 6,
                      "controller.max_iterations", "0", "from 1"),
        after_minimal("no_deadline", "controller: {deadline: 0}\n", 6, "controller.deadline", "0",
                      "a number > 0"),
        after_minimal("negative_deadline", "controller: {deadline: -0.05}\n", 6,
                      "controller.deadline", "-0.05", "a number > 0"),
        after_minimal("deadline_in_words", "controller: {deadline: soon}\n", 6,
                      "controller.deadline", "soon", "a number > 0"),
        after_minimal("endless_deadline", "controller: {deadline: 1e300}\n", 6,
                      "controller.deadline", "1e300", "a number > 0 and <= 1000000"),
        after_minimal("word_for_optimise_gain", "controller: {optimise_gain: some}\n", 6,
                      "controller.optimise_gain", "some", "true or false"),
        after_minimal("no_threads", "controller: {threads: 0}\n", 6, "controller.threads", "0",
                      "a whole number from 1 to 256"),
        after_minimal("too_many_threads", "controller: {threads: 257}\n", 6, "controller.threads",
                      "257", "a whole number from 1 to 256"),
        after_minimal("negative_weight", "controller: {penalty: {obstacle: -1}}\n", 6,
                      "controller.penalty.obstacle", "-1", ">= 0"),
        after_minimal("no_length", "controller: {penalty: {length: 0}}\n", 6,
                      "controller.penalty.length", "0", "> 0"),
        after_minimal("odd_size", "video: {size: 1279x720}\n", 6, "video.size", "1279x720", "even"),
        after_minimal("size_of_one_number", "video: {size: 720}\n", 6, "video.size", "720", "x"),
        after_minimal("huge_size", "video: {size: 100000x720}\n", 6, "video.size", "100000x720",
                      "7680x4320"),
        after_minimal("no_fps", "video: {fps: 0}\n", 6, "video.fps", "0", "from 1 to 240"),
        after_minimal("two_lines", "description: \"a\\nb\"\n", 6, "description", "a", "one line"),
        after_minimal("escaped_control", "description: \"a\\x07b\"\n", 6, "description", "a",
                      "without control characters"),
        Broken{"negative_speed", minimal_with("dubins}", "dubins, speed: -1}"), 2, "model.speed",
               "-1", "speed"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Geometry, BrokenScenario,
    ::testing::Values(
        Broken{"short_mean", minimal_with("[0, 0, 0]", "[0, 0]"), 4, "initial_state.mean",
               "a list of 2", "a list of 3 numbers"},
        Broken{"text_in_mean", minimal_with("[0, 0, 0]", "[0, north, 0]"), 4,
               "initial_state.mean.1", "north", "a finite number"},
        Broken{"infinite_mean", minimal_with("[0, 0, 0]", "[0, .inf, 0]"), 4,
               "initial_state.mean.1", ".inf", "a finite number"},
        Broken{"short_covariance", minimal_with("0]}", "0], covariance: [1, 2]}"), 4,
               "initial_state.covariance", "a list of 2", "3 numbers (a diagonal) or 3 rows of 3"},
        Broken{"negative_variance", minimal_with("0]}", "0], covariance: [1, -2, 1]}"), 4,
               "initial_state.covariance", "the eigenvalue -2", "positive semidefinite"},
        after_minimal("asymmetric",
                      "disturbance:\n  covariance: [[1, 2, 0], [0, 1, 0], [0, 0, 1]]\n", 7,
                      "disturbance.covariance", "transposed entry", "symmetric"),
        after_minimal("indefinite",
                      "disturbance:\n  covariance: [[1, 2, 0], [2, 1, 0], [0, 0, 1]]\n", 7,
                      "disturbance.covariance", "the eigenvalue -1", "positive semidefinite"),
        after_minimal("indefinite_sensor", "disturbance:\n  sensor: [1, 1, -1]\n", 7,
                      "disturbance.sensor", "the eigenvalue -1", "positive semidefinite"),
        after_minimal("sensor_of_two", "disturbance: {sensor: [1, 1]}\n", 6, "disturbance.sensor",
                      "a list of 2", "3 numbers (a diagonal) or 3 rows of 3"),
        after_minimal("ragged",
                      "disturbance:\n  covariance:\n  - [1, 0, 0]\n  - [0, 1]\n  - [0, 0, 1]\n", 9,
                      "disturbance.covariance.1", "a list of 2", "a row of 3 numbers"),
        after_minimal("indefinite_cost", "controller: {cost: {state: [1, 1, -1]}}\n", 6,
                      "controller.cost.state", "eigenvalue -1", "positive semidefinite"),
        after_minimal("negative_input_cost", "controller: {cost: {input: [-1]}}\n", 6,
                      "controller.cost.input", "eigenvalue -1", "positive semidefinite"),
        after_minimal("wrong_gain", "controller: {feedback_gain: [1, 2]}\n", 6,
                      "controller.feedback_gain", "a list of 2", "3 numbers (the row)"),
        after_minimal("bounds_upside_down", "safe_set: {bounds: {x: [1, -1]}}\n", 6,
                      "safe_set.bounds.x", "[1, -1]", "lower < upper"),
        after_minimal("bounds_nan", "safe_set: {bounds: {x: [.nan, 1]}}\n", 6,
                      "safe_set.bounds.x.0", ".nan", "[lower, upper]"),
        after_minimal("bounds_of_three", "safe_set: {bounds: {x: [0, 1, 2]}}\n", 6,
                      "safe_set.bounds.x", "a list of 3", "[lower, upper]"),
        after_minimal("infinite_input_bound", "controller: {input_bounds: {yaw_rate: [0, .inf]}}\n",
                      6, "controller.input_bounds.yaw_rate.1", ".inf", "finite"),
        after_minimal("empty_obstacle", "safe_set: {obstacles: [{}]}\n", 6, "safe_set.obstacles.0",
                      "fills the whole space", "at least one of x, y, heading"),
        after_minimal("obstacle_is_a_list", "safe_set: {obstacles: [[1, 2]]}\n", 6,
                      "safe_set.obstacles.0", "a list of 2", "a mapping"),
        after_minimal("obstacles_are_a_mapping", "safe_set: {obstacles: {x: [1, 2]}}\n", 6,
                      "safe_set.obstacles", "a mapping", "a list"),
        after_minimal("mean_out_of_bounds", "safe_set: {bounds: {x: [1, 9]}}\n", 4,
                      "initial_state.mean", "x = 0, outside of the bounds 1 < x < 9",
                      "a state in the safe set"),
        after_minimal("mean_on_the_bound", "safe_set: {bounds: {x: [0, 9]}}\n", 4,
                      "initial_state.mean", "outside of the bounds", "a state in the safe set"),
        after_minimal("mean_in_an_obstacle", "safe_set: {obstacles: [{x: [7, 8]}, {x: [-1, 1]}]}\n",
                      4, "initial_state.mean", "inside safe_set.obstacles.1", "the safe set"),
        after_minimal("body_beyond_a_bound",
                      "vehicle: {footprint: [{radius: 0.5}]}\nsafe_set: {bounds: {x: [-0.4, 9]}}\n",
                      4, "initial_state.mean", "a body that reaches 0.1 beyond the bounds -0.4 < x",
                      "a state in the safe set"),
        after_minimal("body_in_an_obstacle",
                      "vehicle: {footprint: [{radius: 0.1, offset: [0.4, 0]}]}\n"
                      "safe_set: {obstacles: [{x: [7, 8]}, {x: [0.3, 1]}]}\n",
                      4, "initial_state.mean", "into safe_set.obstacles.1",
                      "a state in the safe set"),
        after_minimal("body_at_the_target_in_an_obstacle",
                      "vehicle: {footprint: [{radius: 0.1, offset: [0.4, 0]}]}\n"
                      "safe_set: {obstacles: [{x: [5.2, 8]}]}\n",
                      5, "target.state", "into safe_set.obstacles.0", "a state in the safe set"),
        after_minimal(
            "body_without_room",
            "vehicle: {footprint: [{radius: 0.5}]}\nsafe_set: {bounds: {y: [-0.4, 0.4]}}\n", 4,
            "initial_state.mean", "a body that has no room within the bounds of y",
            "a state in the safe set"),
        Broken{"angle_that_is_none", minimal_with("[5, 0, 0]", "[5, 0, 0], angles: [heading, y]"),
               5, "target.angles", "y", "states that are angles, one of heading"},
        Broken{"angle_that_is_nearly_one",
               minimal_with("[5, 0, 0]", "[5, 0, 0], angles: [hedding]"), 5, "target.angles",
               "hedding", "heading (known: heading)"},
        Broken{"angle_named_twice",
               minimal_with("[5, 0, 0]", "[5, 0, 0], angles: [heading, heading]"), 5,
               "target.angles", "heading a second time", "each state once"},
        Broken{"angles_without_a_list", minimal_with("[5, 0, 0]", "[5, 0, 0], angles: heading"), 5,
               "target.angles", "heading", "a list"},
        Broken{"angles_of_a_system_that_has_none",
               "name: a\nmodel: {system: double_integrator}\nplant: {kind: analytic}\n"
               "initial_state: {mean: [0, 0]}\ntarget: {state: [0, 0], angles: [position]}\n",
               5, "target.angles", "position", "no state of the system is an angle"},
        after_minimal("target_out_of_bounds", "safe_set: {bounds: {x: [-1, 4]}}\n", 5,
                      "target.state", "x = 5, outside", "a state in the safe set"),
        after_minimal("target_in_an_obstacle", "safe_set: {obstacles: [{x: [5, 8]}]}\n", 5,
                      "target.state", "inside safe_set.obstacles.0", "the safe set"),
        Broken{"huge_target", minimal_with("[5, 0, 0]", "[5, 1e11, 0]"), 5, "target.state", "1e+11",
               "at most 1e+09 in size"},
        Broken{"huge_start", minimal_with("{mean: [0, 0, 0]}", "{mean: [-1e11, 0, 0]}"), 4,
               "initial_state.mean", "-1e+11", "at most 1e+09 in size"},
        Broken{"no_radius", minimal_with("[5, 0, 0]", "[5, 0, 0], radius: 0"), 5, "target.radius",
               "0", "> 0"}),
    name_of);

TEST(BrokenScenarios, the_message_is_one_line_with_all_parts) {
  try {
    (void)parse_scenario(minimal_text + "controller: {horizon: \"a\\nb\"}\n", {.file = "t.yaml"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "t.yaml:6: controller.horizon: found \"a b\", expected a whole number from 1 to "
                 "1000");
  }
}

TEST(BrokenScenarios, a_matrix_asymmetric_by_rounding_is_made_symmetric) {
  const Scenario scenario = parse_scenario(
      minimal_text +
      "disturbance: {covariance: [[1, 0.5, 0], [0.50000000000001, 1, 0], [0, 0, 1]]}\n");
  EXPECT_EQ(scenario.disturbance.covariance, scenario.disturbance.covariance.transpose());
}

TEST(BrokenScenarios, variances_below_those_that_certificates_hold_for_are_refused) {
  for (const std::string key : {"initial_state.covariance", "disturbance.covariance",
                                "disturbance.sensor", "model_error.covariance"}) {
    const std::string section = key.substr(0, key.find('.'));
    const std::string mean = section == "initial_state" ? "mean: [0, 0, 0], " : "";
    const std::string rms = section == "model_error" ? "rms: [0.1, 0.1, 0.1], " : "";
    const auto text = [&](const std::string& covariance) {
      return "--- {name: test, model: {system: dubins}, plant: {kind: analytic, mjcf: \"\"}, "
             "target: {state: [5, 0, 0]}" +
             std::string(section == "initial_state" ? "" : ", initial_state: {mean: [0, 0, 0]}") +
             ", " + section + ": {" + mean + rms + key.substr(key.find('.') + 1) + ": " +
             covariance + "}}\n";
    };
    const InputError::Where where = refusal_of(text("[1, 9.9e-301, 0]"));
    EXPECT_EQ(where.key, key);
    EXPECT_EQ(where.found, "a variance of 9.9e-301");
    EXPECT_EQ(where.expected, "variances that are 0 or at least 1e-300");
    EXPECT_NO_THROW((void)parse_scenario(text("[1, 1e-300, 0]"))) << key;
  }
}

TEST(BrokenScenarios, a_zero_covariance_and_a_zero_cost_are_accepted) {
  const Scenario scenario = parse_scenario(
      minimal_text + "disturbance: {covariance: [0, 0, 0]}\ncontroller: {cost: {input: [0]}}\n");
  EXPECT_TRUE(scenario.disturbance.covariance.isZero(0.0));
  EXPECT_EQ(scenario.controller.cost.input(0, 0), 0.0);
}

}  // namespace broken_scenario_test
}  // namespace qsmpc::harness
