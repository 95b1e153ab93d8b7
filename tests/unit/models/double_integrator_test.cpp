// Properties specific to the double integrator: exact motion, and a Lipschitz constant that is
// attained.
#include "models/dynamics/double_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "models/dynamics/runge_kutta.hpp"
#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace double_integrator_test {

using namespace testing;

TEST(DoubleIntegrator, step_is_that_of_the_runge_kutta_method) {
  const DoubleIntegrator model{.time_step = 0.3};
  const double state[] = {0.4, -1.1};
  const double input = 1.7;
  double next[2];
  double expected[2];
  model.step(state, &input, next);
  runge_kutta_step<2>(
      [&](const double* x, double* slope) {
        slope[0] = x[1];
        slope[1] = input;
      },
      state, model.time_step, expected);
  EXPECT_DOUBLE_EQ(next[0], expected[0]);
  EXPECT_DOUBLE_EQ(next[1], expected[1]);
}

TEST(DoubleIntegrator, lipschitz_constant_is_attained_open_and_closed_loop) {
  const auto point = make_dynamics("double_integrator", {}, kTimeStep);
  // Feedback that increases the constant, so that the regulated part counts.
  for (const Eigen::RowVector2d& gain :
       {Eigen::RowVector2d(0.0, 0.0), Eigen::RowVector2d(-3.0, -2.0),
        Eigen::RowVector2d(9.0, 4.0)}) {
    const double bound = point->lipschitz(gain);
    double attained = 0.0;
    for (int i = 0; i < 3600; ++i) {
      const double angle = i * std::acos(-1.0) / 3600.0;
      const Eigen::Vector2d offset(std::cos(angle), std::sin(angle));
      for (const double slope : {0.0, 1.0}) {  // saturated, or within the bounds
        StateBatch next(2, 1);
        point->step(offset, slope * gain * offset, next);
        attained = std::max(attained, next.norm());
      }
    }
    EXPECT_LE(attained, bound * (1.0 + 1e-12));
    EXPECT_GE(attained, bound * (1.0 - 1e-5));  // the angles are 1e-3 apart
  }
}

TEST(DoubleIntegrator, lipschitz_refuses_a_gain_of_another_shape) {
  const auto point = make_dynamics("double_integrator", {}, kTimeStep);
  EXPECT_THROW((void)point->lipschitz(Eigen::MatrixXd::Zero(2, 1)), std::invalid_argument);
}

}  // namespace double_integrator_test
}  // namespace qsmpc::models
