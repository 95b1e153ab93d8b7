// User-defined systems in scenario files: read, refused with place and reason, and written back.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/dynamics_library.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace own_model_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string source = QSMPC_SOURCE_DIR;
const std::string libraries = QSMPC_OWN_LIBRARIES;

const std::string head =
    "name: test\n"
    "plant: {kind: analytic}\n"
    "initial_state: {mean: [0, 0]}\n"
    "target: {state: [1, 0]}\n"
    "model:\n";
const std::string cart = head +
                         "  states: {position: m, velocity: {unit: m/s}}\n"  // line 6
                         "  inputs: {force: {unit: N, bounds: [-5, 5]}}\n"
                         "  parameters: {mass: {value: 2, unit: kg}, drag: 0.1}\n"
                         "  define: {pull: (force - drag * velocity) / mass}\n"
                         "  equations:\n"  // line 10
                         "    position: position + time_step * velocity\n"
                         "    velocity: velocity + time_step * pull\n";

std::string cart_with(const std::string& from, const std::string& to) {
  std::string text = cart;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

models::StateBatch step_of(const Scenario& scenario) {
  const auto dynamics = make_model(scenario.model, scenario.time_step);
  models::StateBatch next(dynamics->state_dim(), 1);
  dynamics->step(models::StateBatch::Constant(dynamics->state_dim(), 1, 0.5),
                 models::StateBatch::Constant(dynamics->input_dim(), 1, 0.7), next);
  return next;
}

TEST(OwnModel, by_equations_is_read_with_all_that_it_says) {
  const Scenario scenario = parse_scenario(cart, {.overrides = {"model.parameters.drag=0.2"}});
  const models::SystemDescription system = system_of(scenario);
  EXPECT_EQ(system.states.at(1).name, "velocity");
  EXPECT_EQ(system.states.at(1).unit, "m/s");
  EXPECT_EQ(system.input_lower[0], -5.0);
  EXPECT_EQ(scenario.model.parameters.at("drag"), 0.2);
  EXPECT_EQ(scenario.controller.input_upper[0], 5.0);
  EXPECT_DOUBLE_EQ(step_of(scenario)(1, 0), 0.5 + 0.1 * (0.7 - 0.2 * 0.5) / 2.0);
}

void expect_same_after_writing(const Scenario& scenario, const ScenarioSource& how) {
  const std::string text = to_yaml(scenario);
  const Scenario again = parse_scenario(text, how);
  EXPECT_EQ(to_yaml(again), text);
  EXPECT_EQ(again.model.parameters, scenario.model.parameters);
  EXPECT_EQ(step_of(again), step_of(scenario));
}

TEST(OwnModel, by_equations_is_written_back) {
  expect_same_after_writing(parse_scenario(cart), {});
  for (const char* example : {"lag_unicycle", "planar_quadrotor"}) {
    expect_same_after_writing(load_scenario(source + "/examples/" + example + "/scenario.yaml"),
                              {});
  }
}

TEST(OwnModel, from_a_library_is_read_and_written_back) {
  const Scenario scenario = load_scenario(
      source + "/examples/lag_unicycle/scenario_cpp.yaml",
      {"model.library=" + libraries + "/liblag_unicycle.so", "model.parameters.speed_lag=0.4"});
  EXPECT_EQ(scenario.model.system, "lag_unicycle");
  EXPECT_EQ(scenario.model.parameters.at("speed_lag"), 0.4);
  EXPECT_EQ(system_of(scenario).heading, 2);
  expect_same_after_writing(scenario, {});
}

TEST(OwnModel, from_a_library_that_is_gone_is_read_as_it_was_recorded) {
  const Scenario scenario = load_scenario(source + "/examples/lag_unicycle/scenario_cpp.yaml",
                                          {"model.library=" + libraries + "/liblag_unicycle.so"});
  std::string text = to_yaml(scenario);
  const std::size_t at = text.find("liblag");
  text.replace(at, 6, "libgone");
  const Scenario read = parse_scenario(text, {.files_must_exist = false});
  EXPECT_EQ(system_of(read).states.size(), 5U);
  EXPECT_EQ(read.model.parameters, scenario.model.parameters);
  EXPECT_EQ(to_yaml(read), text);
  EXPECT_THAT(refusal_of(text).key, "model.library");
}

TEST(OwnModel, libraries_that_are_loaded_together_keep_to_themselves) {
  const auto unicycle = load_dynamics_library(libraries + "/liblag_unicycle.so");
  const auto quadrotor = load_dynamics_library(libraries + "/libplanar_quadrotor.so");
  EXPECT_THAT(unicycle->names(), ::testing::ElementsAre("lag_unicycle"));
  EXPECT_THAT(quadrotor->names(), ::testing::ElementsAre("planar_quadrotor"));
}

TEST(OwnModel, library_is_not_looked_for_in_folders_of_the_system) {
  EXPECT_THROW((void)load_dynamics_library("libm.so.6"), InputError);
}

struct Refused {
  std::string name;
  std::string text;
  int line;
  std::string key;
  std::string found;
  std::string expected;
};

class RefusedOwnModel : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedOwnModel, says_where_and_why) {
  const Refused& refused = GetParam();
  const InputError::Where where = refusal_of(refused.text);
  EXPECT_EQ(where.line, refused.line);
  EXPECT_EQ(where.key, refused.key);
  EXPECT_THAT(where.found, HasSubstr(refused.found));
  EXPECT_THAT(where.expected, HasSubstr(refused.expected));
}

std::string name_of(const ::testing::TestParamInfo<Refused>& info) { return info.param.name; }

std::string from_library(const std::string& rest) { return head + "  library: " + rest + "\n"; }

INSTANTIATE_TEST_SUITE_P(
    Equations, RefusedOwnModel,
    ::testing::Values(
        Refused{"unknown_name", cart_with("step * pull", "step * pul"), 12,
                "model.equations.velocity", "the name 'pul' in column 24", "pull (known: "},
        Refused{"unknown_function", cart_with("(force", "sine(force"), 9, "model.define.pull",
                "the function 'sine' in column 1", "sin or sinh"},
        Refused{"syntax", cart_with("time_step * velocity", "time_step velocity"), 11,
                "model.equations.position", "'velocity' in column 22", "an operator or the end"},
        Refused{"arity", cart_with("(force", "max(force"), 9, "model.define.pull", "max of 1",
                "max of 2 arguments"},
        Refused{"missing", cart_with("    velocity: velocity + time_step * pull\n", ""), 10,
                "model.equations.velocity", "nothing", "an equation for this state"},
        Refused{"no_state", cart_with("    velocity: ", "    velocty: "), 12,
                "model.equations.velocty", "an equation for 'velocty'",
                "velocity (known: position"},
        Refused{"function_name", cart_with("{pull:", "{exp: 1, pull:"), 9, "model.define.exp",
                "which is a function", "another name"},
        Refused{"cycle", cart_with("{pull:", "{mad: mad + 1, pull:"), 9, "model.define.mad",
                "a circular definition: mad, mad", "circular"},
        Refused{"no_bounds", cart_with(", bounds: [-5, 5]", ""), 7, "model.inputs.force.bounds",
                "nothing", "[lower, upper]"},
        Refused{"input_by_unit", cart_with("{unit: N, bounds: [-5, 5]}", "N"), 7,
                "model.inputs.force", "N", "bounds"},
        Refused{"unknown_key", cart_with("  define:", "  defines:"), 9, "model.defines",
                "an unknown key", "define (known:"},
        Refused{"system_of_the_program", cart + "  system: dubins\n", 13, "model.system", "dubins",
                "a name that no built-in system has"},
        Refused{"position", cart + "  position: [position, hight]\n", 13, "model.position", "hight",
                "one of position, velocity"},
        Refused{"integrator", cart + "  integrator: euler\n", 13, "model.integrator", "euler",
                "model.time: continuous"},
        Refused{"bound_of_no_state", cart + "safe_set: {bounds: {positon: [0, 1]}}\n", 13,
                "safe_set.bounds.positon", "an unknown key", "position"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Libraries, RefusedOwnModel,
    ::testing::Values(
        Refused{"no_file", from_library("no_such.so"), 6, "model.library", "no file no_such.so",
                "a shared library"},
        Refused{"no_library", from_library(source + "/README.md"), 6, "model.library",
                "invalid ELF header", "a shared library"},
        Refused{"no_symbol", from_library(libraries + "/libnothing.so"), 6, "model.library",
                "without the symbol qsmpc_dynamics", "QSMPC_REGISTER_DYNAMICS"},
        Refused{"other_version", from_library(libraries + "/libother_version.so"), 6,
                "model.library", "for version 99", "version 1"},
        Refused{"unknown_system", from_library(libraries + "/libplain_cart.so\n  system: cart"), 7,
                "model.system", "cart", "plain_cart"},
        Refused{"unknown_parameter",
                from_library(libraries + "/libplain_cart.so\n  parameters: {mas: 1}"), 7,
                "model.parameters.mas", "an unknown key", "mass"},
        Refused{"refused_parameter",
                from_library(libraries + "/libplain_cart.so\n  parameters: {mass: -1}"), 7,
                "model.parameters", "a mapping", "mass must be above 0"},
        Refused{"equations_too",
                from_library(libraries + "/libplain_cart.so\n  equations: {position: \"1\"}"), 7,
                "model.equations", "a mapping", "from model.library"},
        Refused{"risk_without_derivatives",
                from_library(libraries + "/libplain_cart.so") + "risk: {plan: 0.1}\n", 7, "risk",
                "risk limits", "no derivatives"}),
    name_of);

TEST(OwnModel, of_doubles_alone_plans_by_differences_and_has_no_certificates) {
  const Scenario scenario = parse_scenario(from_library(libraries + "/libplain_cart.so"));
  EXPECT_THAT(why_no_bound(scenario), HasSubstr("no derivatives"));
  const auto dynamics = make_model(scenario.model, 0.1);
  Eigen::MatrixXd by_state(2, 2);
  Eigen::MatrixXd by_input(2, 1);
  dynamics->jacobians(Eigen::Vector2d(3.0, -2.0), Eigen::VectorXd::Ones(1), by_state, by_input);
  // Differences of a linear step: rounding divided by 2 · 6e-6.
  EXPECT_NEAR(by_state(0, 1), 0.1, 1e-9);
  EXPECT_NEAR(by_input(1, 0), 0.05, 1e-9);
  EXPECT_EQ(dynamics->derivative_bounds(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones())
                .jacobian_upper(0, 0),
            std::numeric_limits<double>::infinity());
  // The recorded scenario says so as well.
  const Scenario recorded = parse_scenario(to_yaml(scenario), {.files_must_exist = false});
  EXPECT_THAT(why_no_bound(recorded), HasSubstr("no derivatives"));
}

}  // namespace own_model_test
}  // namespace qsmpc::harness
