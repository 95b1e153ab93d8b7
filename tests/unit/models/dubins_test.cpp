// Properties specific to the Dubins car: its formula, its Lipschitz constants, its structure.
#include "models/dynamics/dubins.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace dubins_test {

using namespace testing;

constexpr double kSpeed = 1.5;
constexpr double kReach = kSpeed * kTimeStep;
// Vector and scalar versions of cos and sin differ by a few units in the last place.
constexpr double kRounding = 1e-14;

TEST(Dubins, batch_step_equals_the_templated_scalar_step) {
  const auto car = make_dynamics("dubins", {{"speed", kSpeed}}, kTimeStep);
  const Dubins model{.speed = kSpeed, .time_step = kTimeStep};
  std::mt19937_64 generator(3);
  const StateBatch states = random_batch(generator, 3, 41, 3.0);
  const StateBatch inputs = random_batch(generator, 1, 41, 2.0);
  StateBatch next(3, 41);
  car->step(states, inputs, next);
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const Eigen::Vector3d state = states.col(i);
    const double input = inputs(0, i);
    Eigen::Vector3d expected;
    model.step(state.data(), &input, expected.data());
    EXPECT_LE((next.col(i) - expected).cwiseAbs().maxCoeff(), kRounding);
  }
}

TEST(Dubins, drives_ahead_and_turns_as_written) {
  const auto car = make_dynamics("dubins", {{"speed", 2.0}}, 0.5);
  StateBatch state(3, 1);
  state << 1.0, 2.0, 0.0;
  StateBatch next(3, 1);
  car->step(state, StateBatch::Constant(1, 1, 0.4), next);
  EXPECT_DOUBLE_EQ(next(Dubins::kX, 0), 2.0);
  EXPECT_DOUBLE_EQ(next(Dubins::kY, 0), 2.0);
  EXPECT_DOUBLE_EQ(next(Dubins::kHeading, 0), 0.2);
}

TEST(Dubins, heading_is_not_wrapped) {
  const auto car = make_dynamics("dubins", {}, kTimeStep);
  StateBatch state(3, 1);
  state << 0.0, 0.0, 9.9;
  StateBatch next(3, 1);
  car->step(state, StateBatch::Constant(1, 1, 2.0), next);
  EXPECT_NEAR(next(Dubins::kHeading, 0), 10.1, kRounding * 10.0);
}

TEST(Dubins, open_loop_lipschitz_constant_is_the_closed_form_and_attained) {
  const auto car = make_dynamics("dubins", {{"speed", kSpeed}}, kTimeStep);
  const double bound = car->lipschitz(Eigen::MatrixXd::Zero(1, 3));
  EXPECT_NEAR(bound, 0.5 * kReach + std::sqrt(1.0 + 0.25 * kReach * kReach), kRounding);
  EXPECT_NEAR(bound, 1.0778, 5e-5);  // as published, four decimals
  // A pair along the best right singular vector at φ = 0, close enough for second order not to
  // matter (1e-4), attains 1 − 1e-3 of the bound.
  double attained = 0.0;
  for (int i = 0; i < 360; ++i) {
    const double angle = i * std::acos(-1.0) / 360.0;
    StateBatch states = StateBatch::Zero(3, 2);
    states(Dubins::kY, 1) = 1e-4 * std::cos(angle);
    states(Dubins::kHeading, 1) = 1e-4 * std::sin(angle);
    StateBatch next(3, 2);
    car->step(states, StateBatch::Zero(1, 2), next);
    attained = std::max(attained, (next.col(1) - next.col(0)).norm() / 1e-4);
  }
  EXPECT_GE(attained, bound * (1.0 - 1e-3));
  EXPECT_LE(attained, bound * (1.0 + 1e-9));  // rounding of differences of 1e-4
}

TEST(Dubins, lipschitz_refuses_a_gain_of_another_shape) {
  const auto car = make_dynamics("dubins", {}, kTimeStep);
  EXPECT_THROW((void)car->lipschitz(Eigen::MatrixXd::Zero(3, 1)), std::invalid_argument);
}

TEST(Dubins, unicycle_structure_reproduces_the_step) {
  const auto car = make_dynamics("dubins", {{"speed", 0.7}}, 0.2);
  const auto unicycle = car->unicycle();
  ASSERT_TRUE(unicycle.has_value());
  std::mt19937_64 generator(5);
  const StateBatch states = random_batch(generator, 3, 11, 3.0);
  const StateBatch inputs = random_batch(generator, 1, 11, 2.0);
  StateBatch next(3, 11);
  car->step(states, inputs, next);
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const double heading = states(unicycle->heading, i);
    EXPECT_NEAR(next(unicycle->x, i), states(unicycle->x, i) + unicycle->reach * std::cos(heading),
                kRounding);
    EXPECT_NEAR(next(unicycle->y, i), states(unicycle->y, i) + unicycle->reach * std::sin(heading),
                kRounding);
    EXPECT_NEAR(next(unicycle->heading, i),
                heading + unicycle->input_gain * inputs(unicycle->input, i), kRounding);
  }
}

}  // namespace dubins_test
}  // namespace qsmpc::models
