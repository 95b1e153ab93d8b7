// Systems by formulas: their values, and refused systems.
#include <cmath>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "models/dynamics/equations/equation_system.hpp"
#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace equations_test {

using namespace testing;
using ::testing::HasSubstr;

/// One state a and one input u, whose next state is `formula`.
EquationSystem system_of(const std::string& formula) {
  return {.states = {{"a", "m"}},
          .inputs = {{"u", "m"}},
          .input_lower = Eigen::VectorXd::Constant(1, -1.0),
          .input_upper = Eigen::VectorXd::Constant(1, 1.0),
          .parameters = {{"p", 3.0}},
          .equations = {{"a", formula}}};
}

double value_of(const std::string& formula, double a, double u) {
  const auto dynamics = make_equation_dynamics(system_of(formula), kTimeStep);
  StateBatch next(1, 1);
  dynamics->step(StateBatch::Constant(1, 1, a), StateBatch::Constant(1, 1, u), next);
  return next(0, 0);
}

TEST(Equations, compute_what_is_written) {
  const double a = 0.7;
  const double u = -0.4;
  const std::vector<std::pair<std::string, double>> formulas = {
      {"a + u * p", a + u * 3.0},
      {"-a^2", -a * a},
      {"2^-a", std::pow(2.0, -a)},
      {"a^3 + a^-1", a * a * a + 1.0 / a},
      {"time_step * pi", kTimeStep * std::numbers::pi},
      {"min(a, u) + 10 * max(a, u)", u + 10.0 * a},
      {"abs(u) - abs(a)", 0.4 - 0.7},
      {"asin(u) + acos(u) + atan(u)", std::asin(u) + std::acos(u) + std::atan(u)},
      {"atan2(u, -a)", std::atan2(u, -a)},
      {"exp(u) + log(a) + sqrt(a)", std::exp(u) + std::log(a) + std::sqrt(a)},
      {"sinh(u) * cosh(a) / tanh(a)", std::sinh(u) * std::cosh(a) / std::tanh(a)},
      {"sin(a) + cos(u) + tan(a)", std::sin(a) + std::cos(u) + std::tan(a)},
      {"(a - u) / (a + u)", (a - u) / (a + u)},
      {"3 - a / 4 + 5 / a", 3.0 - a / 4.0 + 5.0 / a},
  };
  for (const auto& [formula, expected] : formulas) {
    EXPECT_NEAR(value_of(formula, a, u), expected, 1e-14 * (1.0 + std::abs(expected))) << formula;
  }
}

TEST(Equations, give_nan_where_there_is_no_value) {
  for (const char* formula : {"log(a)", "sqrt(a)", "asin(2 * a)", "a^0.3", "min(1, sqrt(a))",
                              "max(sqrt(a), 1)", "min(sqrt(a), 1)"}) {
    EXPECT_TRUE(std::isnan(value_of(formula, -1.0, 0.0))) << formula;
  }
}

TEST(Equations, of_the_bicycle_are_the_bicycle) {
  EquationSystem bicycle{
      .states = {{"x", "m"}, {"y", "m"}, {"heading", "rad"}, {"v", "m/s"}, {"w", "m/s"}, {"r", ""}},
      .inputs = {{"acceleration", ""}, {"steering", "rad"}},
      .input_lower = Eigen::Vector2d(-5.0, -0.7),
      .input_upper = Eigen::Vector2d(2.0, 0.7),
      .definitions = {{"S", "-time_step * (kf + kr)"},
                      {"P", "-time_step * (lf^2 * kf + lr^2 * kr)"},
                      {"c", "time_step * (lf * kf - lr * kr)"},
                      {"F", "1 / (m * v + S)"},
                      {"G", "1 / (I * v + P)"}},
      .equations = {{"r", "(1 - P*G) * (r - time_step * lf * kf / I * steering) + c * w * G"},
                    {"x", "x + time_step * (v * cos(heading) - w * sin(heading))"},
                    {"y", "y + time_step * (w * cos(heading) + v * sin(heading))"},
                    {"heading", "heading + time_step * r"},
                    {"v", "v + time_step * acceleration"},
                    {"w",
                     "(1 - S*F) * (w - time_step * (v*r) - time_step * kf/m * steering) + "
                     "c * r * F"}}};
  bicycle.parameters = {{"m", 1412.0}, {"I", 1536.7},     {"lf", 1.06},
                        {"lr", 1.85},  {"kf", -128916.0}, {"kr", -85944.0}};
  const auto ours = make_dynamics("bicycle", {}, kTimeStep);
  const auto equations = make_equation_dynamics(bicycle, kTimeStep);
  std::mt19937_64 generator(1);
  StateBatch states = random_batch(generator, 6, 300, 1.0);
  states.row(3).array() += 8.0;
  const StateBatch inputs = random_batch(generator, 2, 300, 0.5);
  StateBatch expected(6, 300);
  StateBatch next(6, 300);
  ours->step(states, inputs, expected);
  equations->step(states, inputs, next);
  EXPECT_LE((next - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Equations, do_not_depend_on_the_size_of_the_batch) {
  const auto dynamics = make_any_dynamics("every_function", kTimeStep);
  std::mt19937_64 generator(2);
  for (const Eigen::Index count : {1, 7, 8, 127, 128, 129, 300}) {
    const StateBatch states = random_batch(generator, 2, count, 2.0);
    const StateBatch inputs = random_batch(generator, 1, count, 1.0);
    StateBatch next(2, count);
    dynamics->step(states, inputs, next);
    for (Eigen::Index i = 0; i < count; ++i) {
      StateBatch one(2, 1);
      dynamics->step(states.col(i), inputs.col(i), one);
      EXPECT_EQ(one.col(0), next.col(i)) << i << " of " << count;  // bit for bit
    }
  }
}

TEST(Equations, integrate_continuous_ones) {
  EquationSystem decay = system_of("-p * a + u");
  const double rate = 3.0;
  const double exact = 2.0 * std::exp(-rate * kTimeStep);
  const auto error_of = [&](EquationSystem::Time time, int substeps) {
    decay.time = time;
    decay.substeps = substeps;
    StateBatch next(1, 1);
    make_equation_dynamics(decay, kTimeStep)
        ->step(StateBatch::Constant(1, 1, 2.0), StateBatch::Zero(1, 1), next);
    return std::abs(next(0, 0) - exact);
  };
  // Of first and fourth order.
  const double euler = error_of(EquationSystem::Time::kEuler, 10);
  EXPECT_NEAR(error_of(EquationSystem::Time::kEuler, 20) / euler, 0.5, 0.02);
  const double fourth = error_of(EquationSystem::Time::kRungeKutta, 1);
  EXPECT_NEAR(error_of(EquationSystem::Time::kRungeKutta, 2) / fourth, 1.0 / 16.0, 0.01);
}

TEST(Equations, in_cpp_and_by_formulas_are_the_same) {
  std::mt19937_64 generator(3);
  for (const std::string name : {"lag_unicycle", "planar_quadrotor"}) {
    const auto in_cpp = make_any_dynamics(name, kTimeStep);
    const auto by_formulas = make_any_dynamics(name + "_by_equations", kTimeStep);
    const int dim = in_cpp->state_dim();
    const StateBatch states = random_batch(generator, dim, 50, 2.0);
    const StateBatch inputs = random_batch(generator, 2, 50, 1.0);
    StateBatch one(dim, 50);
    StateBatch other(dim, 50);
    in_cpp->step(states, inputs, one);
    by_formulas->step(states, inputs, other);
    EXPECT_EQ(one, other) << name;
    const StateBatch adjoint = random_batch(generator, dim, 50, 1.0);
    StateBatch input_one(2, 50);
    StateBatch input_other(2, 50);
    in_cpp->pullback(states, inputs, adjoint, one, input_one);
    by_formulas->pullback(states, inputs, adjoint, other, input_other);
    EXPECT_EQ(one, other) << name;
    EXPECT_EQ(input_one, input_other) << name;
  }
}

TEST(Equations, recorded_from_cpp_are_what_is_compiled) {
  std::mt19937_64 generator(4);
  for (const std::string name : {"lag_unicycle", "planar_quadrotor"}) {
    const auto recorded = make_any_dynamics(name, kTimeStep);
    const auto compiled = make_built_in(name, kTimeStep);
    const int dim = recorded->state_dim();
    const StateBatch states = random_batch(generator, dim, 50, 2.0);
    const StateBatch inputs = random_batch(generator, 2, 50, 1.0);
    const StateBatch adjoint = random_batch(generator, dim, 50, 1.0);
    StateBatch one(dim, 50);
    StateBatch other(dim, 50);
    recorded->step(states, inputs, one);
    compiled->step(states, inputs, other);
    // Sines may differ in the last place.
    EXPECT_LE((one - other).cwiseAbs().maxCoeff(), 1e-14) << name;
    StateBatch input_one(2, 50);
    StateBatch input_other(2, 50);
    recorded->pullback(states, inputs, adjoint, one, input_one);
    compiled->pullback(states, inputs, adjoint, other, input_other);
    EXPECT_LE((one - other).cwiseAbs().maxCoeff(), 1e-13) << name;
    EXPECT_LE((input_one - input_other).cwiseAbs().maxCoeff(), 1e-13) << name;
  }
}

struct WrongSystem {
  const char* name;
  std::function<void(EquationSystem&)> spoil;
  const char* section;
  const char* key;
  const char* found;
  const char* expected;  // or a known name
};

class WrongEquations : public ::testing::TestWithParam<WrongSystem> {};

TEST_P(WrongEquations, are_refused_with_what_is_wrong) {
  const WrongSystem& wrong = GetParam();
  EquationSystem system = system_of("a + u");
  wrong.spoil(system);
  try {
    (void)make_equation_dynamics(system, kTimeStep);
    FAIL();
  } catch (const EquationError& error) {
    EXPECT_EQ(error.where().section, wrong.section);
    EXPECT_EQ(error.where().name, wrong.key);
    EXPECT_THAT(error.where().found, HasSubstr(wrong.found));
    EXPECT_THAT(std::string(error.what()), HasSubstr(wrong.expected));
  }
}

std::string name_of(const ::testing::TestParamInfo<WrongSystem>& info) { return info.param.name; }

void define(EquationSystem& system, const char* name, const char* formula) {
  system.definitions.push_back({name, formula});
}

INSTANTIATE_TEST_SUITE_P(
    Systems, WrongEquations,
    ::testing::Values(
        WrongSystem{"unknown_name", [](auto& s) { s.equations[0].text = "a + velocty"; },
                    "equations", "a", "'velocty' in column 5", "one of a, p, pi, time_step, u"},
        WrongSystem{"syntax", [](auto& s) { s.equations[0].text = "a + * u"; }, "equations", "a",
                    "'*' in column 5", "a number, a name or '('"},
        WrongSystem{"missing_equation", [](auto& s) { s.equations.clear(); }, "equations", "a",
                    "nothing", "an equation for this state"},
        WrongSystem{"equation_of_no_state",
                    [](auto& s) {
                      s.equations.push_back({"b", "a"});
                    },
                    "equations", "b", "an equation for 'b'", "one of a"},
        WrongSystem{"name_of_a_function", [](auto& s) { s.states[0].name = "sin"; }, "states",
                    "sin", "'sin', which is a function", "another name"},
        WrongSystem{"name_of_the_period", [](auto& s) { s.inputs[0].name = "time_step"; }, "inputs",
                    "time_step", "the control period", "another name"},
        WrongSystem{"name_twice", [](auto& s) { s.parameters[0].name = "u"; }, "parameters", "u",
                    "which is an input", "another name"},
        WrongSystem{"no_name", [](auto& s) { define(s, "2b", "a"); }, "define", "2b", "'2b'",
                    "a letter"},
        WrongSystem{"circle",
                    [](auto& s) {
                      define(s, "b", "c + 1");
                      define(s, "c", "b * 2");
                      s.equations[0].text = "a + b";
                    },
                    "define", "b", "a circular definition: b, c, b", "circular"},
        WrongSystem{"unused_and_wrong", [](auto& s) { define(s, "b", "zzz"); }, "define", "b",
                    "'zzz' in column 1", "one of a, b, p"},
        WrongSystem{"no_states", [](auto& s) { s.states.clear(); }, "states", "", "none", "one"},
        WrongSystem{"too_long",
                    [](auto& s) {
                      s.time = EquationSystem::Time::kRungeKutta;
                      s.substeps = kMostSubsteps;
                      std::string formula = "a";
                      for (int i = 0; formula.size() < 9900; ++i) {
                        formula += "+sin(" + std::to_string(i) + "*a)";
                      }
                      s.equations[0].text = formula;
                    },
                    "equations", "", "too long", "fewer substeps"}),
    name_of);

// At a kink, a pole or the end of a domain, unknown bounds are infinite and never NaN.
class UnknownDerivatives : public ::testing::TestWithParam<const char*> {};

TEST_P(UnknownDerivatives, are_bounded_by_infinity) {
  const auto dynamics = make_equation_dynamics(system_of(GetParam()), kTimeStep);
  const DerivativeBounds bounds =
      dynamics->derivative_bounds(Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(1.0, 1.0));
  EXPECT_TRUE(bounds.hessian_lower[0](0, 0) == -kInfinity ||
              bounds.hessian_upper[0](0, 0) == kInfinity);
  EXPECT_FALSE(bounds.jacobian_lower.hasNaN() || bounds.jacobian_upper.hasNaN());
  EXPECT_FALSE(bounds.hessian_lower[0].hasNaN() || bounds.hessian_upper[0].hasNaN());
}

INSTANTIATE_TEST_SUITE_P(Formulas, UnknownDerivatives,
                         ::testing::Values("1 / a", "sqrt(a)", "log(a)", "asin(2 * a)", "abs(a)",
                                           "min(a, u)", "max(a, u)", "atan2(a, u)", "a^0.3", "a^-2",
                                           "abs(a)^u", "tan(2 * a)", "1 / (a - u)",
                                           "0 / 0 + a * (1/0)*a"));

TEST(Equations, bound_the_slopes_at_kinks_by_those_of_both_sides) {
  const auto dynamics = make_equation_dynamics(system_of("abs(a) + max(0, u)"), kTimeStep);
  const DerivativeBounds bounds =
      dynamics->derivative_bounds(Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(1.0, 1.0));
  EXPECT_NEAR(bounds.jacobian_lower(0, 0), -1.0, 1e-12);
  EXPECT_NEAR(bounds.jacobian_upper(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(bounds.jacobian_lower(0, 1), 0.0, 1e-12);
  EXPECT_NEAR(bounds.jacobian_upper(0, 1), 1.0, 1e-12);
  EXPECT_NEAR(dynamics->lipschitz(Eigen::MatrixXd::Zero(1, 1)), 1.0, 1e-9);
}

TEST(Equations, jump_where_the_angle_does) {
  const auto dynamics = make_equation_dynamics(system_of("atan2(u, a)"), kTimeStep);
  const DerivativeBounds across =
      dynamics->derivative_bounds(Eigen::Vector2d(-2.0, -0.1), Eigen::Vector2d(-1.0, 0.1));
  EXPECT_EQ(across.jacobian_upper(0, 1), kInfinity);
  const DerivativeBounds beside =
      dynamics->derivative_bounds(Eigen::Vector2d(-2.0, 0.1), Eigen::Vector2d(-1.0, 0.2));
  EXPECT_LT(beside.jacobian_upper(0, 1), 0.0);
  EXPECT_GT(beside.jacobian_lower(0, 1), -kInfinity);
}

}  // namespace equations_test
}  // namespace qsmpc::models
