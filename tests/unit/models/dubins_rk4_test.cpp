// Properties specific to the Dubins car by the Runge-Kutta method: it drives along arcs, and its
// Lipschitz constants.
#include "models/dynamics/dubins_rk4.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "models/dynamics/dubins.hpp"
#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace dubins_rk4_test {

using namespace testing;

using State = Eigen::Vector3d;

constexpr double kSpeed = 1.5;
constexpr double kReach = kSpeed * kTimeStep;
constexpr double kRounding = 1e-14;  // a few units in the last place of values up to ten

State step_of(const DubinsRk4& model, const State& state, double yaw_rate) {
  State next;
  model.step(state.data(), &yaw_rate, next.data());
  return next;
}

/// The end point of an arc of radius v/u after `duration` (s), u ≠ 0.
State arc(const State& state, double yaw_rate, double duration) {
  const double radius = kSpeed / yaw_rate;
  const double begin = state[DubinsRk4::kHeading];
  const double end = begin + yaw_rate * duration;
  return {state[DubinsRk4::kX] + radius * (std::sin(end) - std::sin(begin)),
          state[DubinsRk4::kY] - radius * (std::cos(end) - std::cos(begin)), end};
}

TEST(DubinsRk4, position_is_simpsons_rule_in_the_heading) {
  const DubinsRk4 model{.speed = kSpeed, .time_step = kTimeStep};
  const State state(1.0, -2.0, 0.7);
  const double turn = 1.9 * kTimeStep;
  const State next = step_of(model, state, 1.9);
  const auto mean_of = [&](double (*function)(double)) {
    return (function(0.7) + 4.0 * function(0.7 + 0.5 * turn) + function(0.7 + turn)) / 6.0;
  };
  const auto cosine = [](double angle) { return std::cos(angle); };
  const auto sine = [](double angle) { return std::sin(angle); };
  EXPECT_NEAR(next[DubinsRk4::kX], 1.0 + kReach * mean_of(cosine), kRounding);
  EXPECT_NEAR(next[DubinsRk4::kY], -2.0 + kReach * mean_of(sine), kRounding);
  EXPECT_NEAR(next[DubinsRk4::kHeading], 0.7 + turn, kRounding);
}

TEST(DubinsRk4, drives_straight_ahead_exactly_as_by_euler) {
  const State state(1.0, -2.0, 0.7);
  const State next = step_of({.speed = kSpeed, .time_step = kTimeStep}, state, 0.0);
  const double none = 0.0;
  State euler;
  Dubins{.speed = kSpeed, .time_step = kTimeStep}.step(state.data(), &none, euler.data());
  EXPECT_LE((next - euler).cwiseAbs().maxCoeff(), kRounding);
}

TEST(DubinsRk4, stays_on_the_arc_within_the_bound_of_simpsons_rule) {
  for (const double period : {0.05, 0.3, 1.0}) {
    const DubinsRk4 model{.speed = kSpeed, .time_step = period};
    for (const double yaw_rate : {-2.0, -0.4, 0.1, 2.0}) {
      for (const double heading : {-3.0, 0.0, 1.2}) {
        const State state(0.0, 0.0, heading);
        const State error = step_of(model, state, yaw_rate) - arc(state, yaw_rate, period);
        const double bound = kSpeed * period * std::pow(yaw_rate * period, 4) / 2880.0;
        EXPECT_LE(error.head<2>().norm(), bound + kRounding);
        // The bound uses the maximum of the fourth derivative, which changes little over a period.
        EXPECT_GE(error.head<2>().norm(), 0.8 * bound - kRounding);
        EXPECT_NEAR(error[DubinsRk4::kHeading], 0.0, kRounding);
      }
    }
  }
}

/// Distance from the arc after one second, with periods of 1/count seconds.
double error_after_a_second(int count) {
  const DubinsRk4 model{.speed = kSpeed, .time_step = 1.0 / count};
  const State begin(0.4, -0.2, 0.3);
  State state = begin;
  for (int k = 0; k < count; ++k) state = step_of(model, state, 1.7);
  return (state - arc(begin, 1.7, 1.0)).norm();
}

TEST(DubinsRk4, halving_the_period_divides_the_error_by_sixteen) {
  // Fourth order; the next term is smaller by (uT)² ≈ 0.2 and its factor.
  EXPECT_NEAR(error_after_a_second(4) / error_after_a_second(8), 16.0, 0.1);
  EXPECT_NEAR(error_after_a_second(8) / error_after_a_second(16), 16.0, 0.1);
}

TEST(DubinsRk4, is_described_as_the_dubins_car) {
  const auto euler = make_dynamics("dubins", {}, kTimeStep);
  const auto car = make_dynamics("dubins_rk4", {}, kTimeStep);
  const SystemDescription& expected = euler->description();
  const SystemDescription& found = car->description();
  for (int i = 0; i < DubinsRk4::kStateDim; ++i) {
    EXPECT_EQ(found.states[i].name, expected.states[i].name);
    EXPECT_EQ(found.states[i].unit, expected.states[i].unit);
    EXPECT_EQ(found.states[i].is_angle, expected.states[i].is_angle);
  }
  EXPECT_EQ(found.inputs[0].name, expected.inputs[0].name);
  EXPECT_EQ(found.input_lower, expected.input_lower);
  EXPECT_EQ(found.input_upper, expected.input_upper);
  EXPECT_EQ(found.position_x, DubinsRk4::kX);
  EXPECT_EQ(found.position_y, DubinsRk4::kY);
  EXPECT_EQ(found.heading, DubinsRk4::kHeading);
  // Its position depends on the yaw rate of the same period, so it has no unicycle structure.
  EXPECT_FALSE(car->unicycle().has_value());
}

TEST(DubinsRk4, open_loop_lipschitz_constant_is_that_of_a_straight_period) {
  const auto car = make_dynamics("dubins_rk4", {{"speed", kSpeed}}, kTimeStep);
  const double bound = car->lipschitz(Eigen::MatrixXd::Zero(1, 3));
  EXPECT_NEAR(bound, 0.5 * kReach + std::sqrt(1.0 + 0.25 * kReach * kReach), kRounding);
}

TEST(DubinsRk4, lipschitz_constant_is_little_above_what_jacobians_attain) {
  const auto car = make_dynamics("dubins_rk4", {{"speed", kSpeed}}, kTimeStep);
  std::mt19937_64 generator(11);
  for (int repetition = 0; repetition < 200; ++repetition) {
    const Eigen::RowVector3d gain = random_batch(generator, 1, 3, 4.0);
    double attained = 0.0;
    for (int i = 0; i < 360; ++i) {
      // With the feedback's yaw rate, within its bounds; and straight ahead, saturated.
      const State state(0.0, 0.0, 2.0 * std::numbers::pi * i / 360.0);
      Eigen::MatrixXd by_state(3, 3);
      Eigen::MatrixXd by_input(3, 1);
      car->jacobians(state, Eigen::VectorXd::Zero(1), by_state, by_input);
      attained = std::max(attained, by_state.operatorNorm());
      attained = std::max(attained, (by_state + by_input * gain).operatorNorm());
    }
    const double bound = car->lipschitz(gain);
    EXPECT_LE(attained, bound * (1.0 + 1e-12));
    EXPECT_GE(attained, bound * 0.8);  // its blocks are largest in different directions
  }
}

TEST(DubinsRk4, invalid_speeds_and_gains_are_refused) {
  for (const double speed : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_THROW((void)make_dynamics("dubins_rk4", {{"speed", speed}}, kTimeStep),
                 std::invalid_argument);
  }
  const auto car = make_dynamics("dubins_rk4", {}, kTimeStep);
  EXPECT_THROW((void)car->lipschitz(Eigen::MatrixXd::Zero(3, 1)), std::invalid_argument);
}

}  // namespace dubins_rk4_test
}  // namespace qsmpc::models
