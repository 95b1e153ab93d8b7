// Properties specific to the dynamic bicycle: its equation, its physics, its poles.
#include "models/dynamics/bicycle.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace bicycle_test {

using namespace testing;

constexpr double kMass = 1412.0;
constexpr double kInertia = 1536.7;
constexpr double kFront = 1.06;
constexpr double kRear = 1.85;
constexpr double kFrontStiffness = -128916.0;
constexpr double kRearStiffness = -85944.0;

using State = Eigen::Matrix<double, Bicycle::kStateDim, 1>;
using Input = Eigen::Matrix<double, Bicycle::kInputDim, 1>;

State step_of(const Dynamics& car, const State& state, const Input& input) {
  StateBatch next(Bicycle::kStateDim, 1);
  car.step(state, input, next);
  return next.col(0);
}

State driving(double speed) {
  State state = State::Zero();
  state[Bicycle::kLongitudinalSpeed] = speed;
  return state;
}

/// Eq. 5-4 as published.
State printed_step(const State& x, const Input& u) {
  const double t = kTimeStep;
  const double heading = x[2], v = x[3], lateral = x[4], rate = x[5];
  const double coupling = kFront * kFrontStiffness - kRear * kRearStiffness;
  State next;
  next[0] = x[0] + t * (v * std::cos(heading) - lateral * std::sin(heading));
  next[1] = x[1] + t * (lateral * std::cos(heading) + v * std::sin(heading));
  next[2] = heading + t * rate;
  next[3] = v + t * u[0];
  next[4] = (kMass * v * lateral + t * coupling * rate - t * kFrontStiffness * u[1] * v -
             t * kMass * v * v * rate) /
            (kMass * v - t * (kFrontStiffness + kRearStiffness));
  next[5] =
      (kInertia * v * rate + t * coupling * lateral - t * kFront * kFrontStiffness * u[1] * v) /
      (kInertia * v - t * (kFront * kFront * kFrontStiffness + kRear * kRear * kRearStiffness));
  return next;
}

/// ẋ of the continuous single-track model with linear tyres, from the axle forces.
State continuous_derivative(const State& x, const Input& u) {
  const double heading = x[2], v = x[3], lateral = x[4], rate = x[5];
  const double front_force = kFrontStiffness * ((lateral + kFront * rate) / v - u[1]);
  const double rear_force = kRearStiffness * ((lateral - kRear * rate) / v);
  State slope;
  slope << v * std::cos(heading) - lateral * std::sin(heading),
      v * std::sin(heading) + lateral * std::cos(heading), rate, u[0],
      (front_force + rear_force) / kMass - v * rate,
      (kFront * front_force - kRear * rear_force) / kInertia;
  return slope;
}

class BicycleTest : public ::testing::Test {
 protected:
  State random_state() {
    State state = random_batch(generator_, Bicycle::kStateDim, 1, 1.0).col(0);
    state[Bicycle::kLongitudinalSpeed] = 6.0 + 4.0 * state[Bicycle::kLongitudinalSpeed];
    return state;
  }
  Input random_input() { return random_batch(generator_, Bicycle::kInputDim, 1, 0.5).col(0); }

  std::mt19937_64 generator_{31};
  std::unique_ptr<const Dynamics> car_ = make_dynamics("bicycle", {}, kTimeStep);
};

TEST_F(BicycleTest, step_is_the_printed_equation) {
  for (int repetition = 0; repetition < 100; ++repetition) {
    const State state = random_state();
    const Input input = random_input();
    // Two forms of the same rational function, for values of order ten.
    EXPECT_LE((step_of(*car_, state, input) - printed_step(state, input)).cwiseAbs().maxCoeff(),
              1e-13);
  }
}

// The method is of first order: the slope of a step of length T differs from the derivative by T
// times the second derivative, here of order 1e4 (the tyres' rates are about 100 / s).
TEST_F(BicycleTest, short_steps_follow_the_continuous_equations) {
  constexpr double kShort = 1e-8;
  const auto car = make_dynamics("bicycle", {}, kShort);
  for (int repetition = 0; repetition < 100; ++repetition) {
    const State state = random_state();
    const Input input = random_input();
    const State slope = (step_of(*car, state, input) - state) / kShort;
    EXPECT_LE((slope - continuous_derivative(state, input)).cwiseAbs().maxCoeff(), 1e-3);
  }
}

// In steady cornering ω = vδ / (l + K v²) with the wheelbase l and the understeer gradient
// K = m (l_r/C_f − l_f/C_r)/l, C = −k.
TEST_F(BicycleTest, steady_yaw_rate_is_that_of_the_understeer_gradient) {
  const double wheelbase = kFront + kRear;
  const double gradient = kMass / wheelbase * (kRear / -kFrontStiffness - kFront / -kRearStiffness);
  const Input left(0.0, 0.04);
  for (const double speed : {2.0, 5.0, 12.0}) {
    State state = driving(speed);
    for (int k = 0; k < 400; ++k) state = step_of(*car_, state, left);
    EXPECT_NEAR(state[Bicycle::kYawRate],
                speed * left[Bicycle::kSteeringAngle] / (wheelbase + gradient * speed * speed),
                1e-10);  // rounding of 400 steps
  }
}

TEST_F(BicycleTest, steering_to_the_left_turns_and_carries_it_to_the_left) {
  const Input left(0.0, 0.1);
  State state = driving(5.0);
  for (int k = 0; k < 10; ++k) state = step_of(*car_, state, left);
  EXPECT_GT(state[Bicycle::kYawRate], 0.1);
  EXPECT_GT(state[Bicycle::kHeading], 0.05);
  EXPECT_GT(state[Bicycle::kY], 0.05);
  EXPECT_GT(state[Bicycle::kX], 4.0);
}

TEST_F(BicycleTest, stands_still_without_blowing_up) {
  State state = driving(0.0);
  state[Bicycle::kLateralSpeed] = 0.5;
  state[Bicycle::kYawRate] = 0.5;
  for (int k = 0; k < 100; ++k) state = step_of(*car_, state, Input::Zero());
  EXPECT_TRUE(state.allFinite());
  EXPECT_LE(std::abs(state[Bicycle::kLateralSpeed]), 0.5);
  EXPECT_LE(std::abs(state[Bicycle::kYawRate]), 0.5);
}

TEST_F(BicycleTest, box_around_the_pole_bounds_only_derivatives_without_one) {
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(8, -1.0);
  Eigen::VectorXd upper = Eigen::VectorXd::Constant(8, 1.0);
  lower[Bicycle::kLongitudinalSpeed] = -16.0;
  upper[Bicycle::kLongitudinalSpeed] = -14.0;  // v_y has its pole at -15.2 m/s, ω at -28.6 m/s
  const DerivativeBounds bounds = car_->derivative_bounds(lower, upper);
  EXPECT_EQ(bounds.jacobian_upper(Bicycle::kLateralSpeed, Bicycle::kLongitudinalSpeed), kInfinity);
  EXPECT_EQ(bounds.jacobian_lower(Bicycle::kLateralSpeed, Bicycle::kLongitudinalSpeed), -kInfinity);
  EXPECT_TRUE(bounds.jacobian_upper.row(Bicycle::kX).allFinite());
  EXPECT_TRUE(bounds.jacobian_lower.row(Bicycle::kYawRate).allFinite());
  EXPECT_TRUE(bounds.jacobian_upper.row(Bicycle::kYawRate).allFinite());
  EXPECT_FALSE(bounds.jacobian_lower.hasNaN() || bounds.jacobian_upper.hasNaN());
  for (int i = 0; i < Bicycle::kStateDim; ++i) {
    EXPECT_FALSE(bounds.hessian_lower[i].hasNaN() || bounds.hessian_upper[i].hasNaN());
  }
}

TEST_F(BicycleTest, invalid_parameters_are_refused) {
  for (const char* name : {"mass", "yaw_inertia", "front_axle_distance", "rear_axle_distance"}) {
    for (const double value : {0.0, -1.0, std::nan("")}) {
      EXPECT_THROW((void)make_dynamics("bicycle", {{name, value}}, 0.1), std::invalid_argument);
    }
  }
  for (const char* name : {"front_tyre_stiffness", "rear_tyre_stiffness"}) {
    EXPECT_THROW((void)make_dynamics("bicycle", {{name, 8e4}}, 0.1), std::invalid_argument);
  }
}

TEST_F(BicycleTest, lipschitz_refuses_a_gain_of_another_shape) {
  EXPECT_THROW((void)car_->lipschitz(Eigen::MatrixXd::Zero(6, 2)), std::invalid_argument);
}

}  // namespace bicycle_test
}  // namespace qsmpc::models
