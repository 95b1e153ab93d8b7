// What is particular to the pole on a cart: its equations of motion and its two equilibria.
#include "models/dynamics/cart_pole.hpp"

#include <cmath>
#include <numbers>
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
  // A method of fourth order over 2 s: 1e-12 for rates of about 5 / s.
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

TEST(CartPole, senseless_parameters_are_refused) {
  for (const char* name : {"cart_mass", "pole_mass", "pole_half_length", "gravity"}) {
    for (const double value : {0.0, -1.0, std::nan("")}) {
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
