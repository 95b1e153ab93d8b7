// Properties specific to the cart-pole: its equations of motion, their damping, and its two
// equilibria.
#include "models/dynamics/cart_pole.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace cart_pole_test {

using namespace testing;

using State = Eigen::Vector4d;

constexpr double kPi = std::numbers::pi;
constexpr CartPole kModel{
    .cart_mass = 1.0, .pole_mass = 0.1, .pole_half_length = 0.5, .gravity = 9.8, .time_step = 0.05};

State step_of(const CartPole& model, const State& state, double force) {
  State next;
  model.step(state.data(), &force, next.data());
  return next;
}

/// Kinetic and potential energy of the cart and a uniform pole, J.
double energy(const CartPole& model, const State& x) {
  const double length = model.pole_half_length;
  const double inertia = model.pole_mass * length * length / 3.0;
  const double rate = x[CartPole::kAngularVelocity];
  const double cart = x[CartPole::kVelocity];
  const double along = cart + length * rate * std::cos(x[CartPole::kPoleAngle]);
  const double upwards = -length * rate * std::sin(x[CartPole::kPoleAngle]);
  return 0.5 * model.cart_mass * cart * cart +
         0.5 * model.pole_mass * (along * along + upwards * upwards) + 0.5 * inertia * rate * rate +
         model.pole_mass * model.gravity * length * std::cos(x[CartPole::kPoleAngle]);
}

TEST(CartPole, energy_is_kept_without_a_force) {
  CartPole model = kModel;
  model.time_step = 0.001;
  State state(0.0, 0.4, 0.5, -1.0);
  const double before = energy(model, state);
  for (int k = 0; k < 2000; ++k) state = step_of(model, state, 0.0);
  // A fourth-order method over 2 s: 1e-12 for rates of about 5 / s.
  EXPECT_NEAR(energy(model, state), before, 1e-9);
}

TEST(CartPole, force_does_the_work_that_the_energy_gains) {
  CartPole model = kModel;
  model.time_step = 0.001;
  State state(0.0, 0.0, 0.5, 0.0);
  constexpr double kForce = 3.0;
  const double before = energy(model, state);
  for (int k = 0; k < 1000; ++k) state = step_of(model, state, kForce);
  EXPECT_NEAR(energy(model, state) - before, kForce * state[CartPole::kPosition], 1e-9);
}

TEST(CartPole, damping_takes_what_it_does_not_leave_to_the_energy) {
  CartPole model = kModel;
  model.cart_damping = 0.6;
  model.pole_damping = 0.02;
  model.time_step = 0.001;
  State state(0.0, 1.5, 0.5, -1.0);
  const double before = energy(model, state);
  const auto loss = [&](const State& x) {
    return model.cart_damping * x[CartPole::kVelocity] * x[CartPole::kVelocity] +
           model.pole_damping * x[CartPole::kAngularVelocity] * x[CartPole::kAngularVelocity];
  };
  double lost = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double at_start = loss(state);
    state = step_of(model, state, 0.0);
    lost += 0.5 * model.time_step * (at_start + loss(state));
  }
  // The trapezoidal rule over 2 s: T²/12 times the change of the loss's slope, about 40 W/s.
  EXPECT_NEAR(energy(model, state), before - lost, 1e-5);
  EXPECT_GT(lost, 1.0);
}

TEST(CartPole, cart_under_a_force_tends_to_force_over_damping) {
  CartPole model = kModel;
  model.cart_damping = 2.0;
  model.pole_damping = 0.1;
  State state(0.0, 0.0, kPi, 0.0);
  for (int k = 0; k < 2000; ++k) state = step_of(model, state, 3.0);
  EXPECT_NEAR(state[CartPole::kVelocity], 1.5, 1e-9);
  EXPECT_NEAR(state[CartPole::kPoleAngle], kPi, 1e-9);
}

// Without damping nothing is computed for it: not even the sign of a zero changes.
TEST(CartPole, damping_is_zero_by_default) {
  const auto plain = make_dynamics("cart_pole", {}, 0.05);
  const auto zero =
      make_dynamics("cart_pole", {{"cart_damping", 0.0}, {"pole_damping", 0.0}}, 0.05);
  std::mt19937_64 generator(5);
  const StateBatch states = random_batch(generator, CartPole::kStateDim, 100, 3.0);
  const StateBatch inputs = random_batch(generator, CartPole::kInputDim, 100, 10.0);
  StateBatch first(states.rows(), states.cols());
  StateBatch second(states.rows(), states.cols());
  plain->step(states, inputs, first);
  zero->step(states, inputs, second);
  EXPECT_EQ(first, second);
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    EXPECT_EQ(first.col(i), step_of(kModel, states.col(i), inputs(0, i)));
  }
}

TEST(CartPole, enclosures_of_a_damped_one_hold_its_jacobians) {
  const auto damped =
      make_dynamics("cart_pole", {{"cart_damping", 1.5}, {"pole_damping", 0.05}}, kTimeStep);
  std::mt19937_64 generator(6);
  const StateBatch centres = random_batch(generator, CartPole::kStateDim + 1, 50, 2.0);
  const StateBatch offsets = random_batch(generator, CartPole::kStateDim + 1, 50, 1.0);
  for (Eigen::Index i = 0; i < centres.cols(); ++i) {
    const Eigen::VectorXd lower = centres.col(i).array() - 0.1;
    const Eigen::VectorXd upper = centres.col(i).array() + 0.1;
    const DerivativeBounds bounds = damped->derivative_bounds(lower, upper);
    const Eigen::VectorXd inside = centres.col(i) + 0.1 * offsets.col(i);
    Eigen::MatrixXd by_state(4, 4);
    Eigen::MatrixXd by_input(4, 1);
    damped->jacobians(inside.head(4), inside.tail(1), by_state, by_input);
    Eigen::MatrixXd jacobian(4, 5);
    jacobian << by_state, by_input;
    EXPECT_TRUE((bounds.jacobian_lower.array() <= jacobian.array()).all()) << i;
    EXPECT_TRUE((bounds.jacobian_upper.array() >= jacobian.array()).all()) << i;
  }
}

TEST(CartPole, upright_is_an_equilibrium_that_it_falls_from) {
  EXPECT_EQ(step_of(kModel, State::Zero(), 0.0), State::Zero());
  State state(0.0, 0.0, 0.01, 0.0);
  for (int k = 0; k < 10; ++k) state = step_of(kModel, state, 0.0);
  EXPECT_GT(state[CartPole::kPoleAngle], 0.03);
}

TEST(CartPole, hanging_is_an_equilibrium_that_it_swings_about) {
  State state(0.0, 0.0, kPi + 0.01, 0.0);
  for (int k = 0; k < 200; ++k) {
    state = step_of(kModel, state, 0.0);
    EXPECT_NEAR(state[CartPole::kPoleAngle], kPi, 0.0101);
  }
}

TEST(CartPole, push_moves_the_cart_forwards_and_tips_the_pole_backwards) {
  const State next = step_of(kModel, State::Zero(), 5.0);
  EXPECT_GT(next[CartPole::kVelocity], 0.0);
  EXPECT_LT(next[CartPole::kAngularVelocity], 0.0);
}

TEST(CartPole, invalid_parameters_are_refused) {
  for (const char* name : {"cart_mass", "pole_mass", "pole_half_length", "gravity"}) {
    for (const double value : {0.0, -1.0, std::nan("")}) {
      EXPECT_THROW((void)make_dynamics("cart_pole", {{name, value}}, 0.1), std::invalid_argument);
    }
  }
}

TEST(CartPole, negative_damping_is_refused) {
  for (const char* name : {"cart_damping", "pole_damping"}) {
    for (const double value : {-0.1, std::nan("")}) {
      EXPECT_THROW((void)make_dynamics("cart_pole", {{name, value}}, 0.1), std::invalid_argument);
    }
  }
}

TEST(CartPole, lipschitz_refuses_a_gain_of_another_shape) {
  const auto system = make_dynamics("cart_pole", {}, kTimeStep);
  EXPECT_THROW((void)system->lipschitz(Eigen::MatrixXd::Zero(4, 1)), std::invalid_argument);
}

}  // namespace cart_pole_test
}  // namespace qsmpc::models
