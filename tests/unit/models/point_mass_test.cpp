// Properties specific to the point mass: exact damped motion, and a Lipschitz constant that is
// attained.
#include "models/dynamics/point_mass.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace point_mass_test {

using namespace testing;

StateBatch moved(double damping, double time_step, int periods) {
  const auto point = make_dynamics("point_mass", {{"damping", damping}}, time_step);
  StateBatch state(4, 1);
  state << 0.3, -0.7, 1.5, -0.4;
  StateBatch input(2, 1);
  input << 0.8, -1.9;
  for (int k = 0; k < periods; ++k) {
    StateBatch next(4, 1);
    point->step(state, input, next);
    state = next;
  }
  return state;
}

// Exact: under a held input the motion is the same for any period.
TEST(PointMass, motion_does_not_depend_on_the_period) {
  for (const double damping : {0.0, 1e-6, 9e-4, 0.3, 3.0}) {
    const StateBatch once = moved(damping, 0.4, 1);
    const StateBatch often = moved(damping, 0.4 / 64.0, 64);
    EXPECT_LT((once - often).cwiseAbs().maxCoeff(), 1e-13) << damping;
  }
}

TEST(PointMass, damping_brings_the_speed_to_acceleration_over_damping) {
  const StateBatch end = moved(2.0, 0.5, 100);
  EXPECT_NEAR(end(PointMass::kVelocityX, 0), 0.4, 1e-12);
  EXPECT_NEAR(end(PointMass::kVelocityY, 0), -0.95, 1e-12);
}

TEST(PointMass, lipschitz_constant_holds_and_is_attained) {
  const auto point = make_dynamics("point_mass", {{"damping", 0.5}}, kTimeStep);
  Eigen::MatrixXd gain(2, 4);
  gain << 9.0, 0.0, 4.0, 1.0, 0.0, -3.0, 0.5, -2.0;
  const double bound = point->lipschitz(gain);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  double attained = 0.0;
  for (const double along_x : {0.0, 1.0}) {
    for (const double along_y : {0.0, 1.0}) {
      const Eigen::Vector2d slopes(along_x, along_y);
      // Power iteration on the difference of two steps, through the transposed Jacobian.
      Eigen::VectorXd offset =
          Eigen::VectorXd::NullaryExpr(4, [&] { return normal(generator); }).normalized();
      for (int k = 0; k < 300; ++k) {
        StateBatch next(4, 1);
        const Eigen::Vector2d input = slopes.cwiseProduct(gain * offset);
        point->step(offset, input, next);
        attained = std::max(attained, next.norm());
        StateBatch by_state(4, 1);
        StateBatch by_input(2, 1);
        point->pullback(offset, input, next, by_state, by_input);
        offset = (by_state.col(0) + gain.transpose() * slopes.cwiseProduct(by_input.col(0)))
                     .normalized();
      }
    }
  }
  EXPECT_LE(attained, bound * (1.0 + 1e-12));
  EXPECT_GE(attained, bound * (1.0 - 1e-6));
}

TEST(PointMass, refuses_a_negative_damping_and_a_gain_of_another_shape) {
  EXPECT_THROW((void)make_dynamics("point_mass", {{"damping", -0.1}}, kTimeStep),
               std::invalid_argument);
  EXPECT_THROW((void)make_dynamics("point_mass", {{"damping", std::nan("")}}, kTimeStep),
               std::invalid_argument);
  const auto point = make_dynamics("point_mass", {}, kTimeStep);
  EXPECT_THROW((void)point->lipschitz(Eigen::MatrixXd::Zero(1, 4)), std::invalid_argument);
}

}  // namespace point_mass_test
}  // namespace qsmpc::models
