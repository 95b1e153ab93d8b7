// Lipschitz constants over boxes, of every system, open and closed loop.
#include "models/dynamics/local_lipschitz.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace local_lipschitz_test {

using namespace testing;

/// x ↦ f(x, clamp(v + K x)) on a box of states.
struct BoxedLoop {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  Eigen::MatrixXd gain;
  Eigen::VectorXd constant;
  Eigen::VectorXd input_lower;
  Eigen::VectorXd input_upper;

  [[nodiscard]] Eigen::VectorXd input(const Eigen::VectorXd& state) const {
    return (constant + gain * state).cwiseMax(input_lower).cwiseMin(input_upper);
  }
  [[nodiscard]] DerivativeBounds derivative_bounds(const Dynamics& dynamics) const {
    Eigen::VectorXd low(lower.size() + input_lower.size());
    Eigen::VectorXd high(low.size());
    low << lower, input_lower;
    high << upper, input_upper;
    return dynamics.derivative_bounds(low, high);
  }
};

class LocalLipschitzOfEverySystem : public EverySystem {
 protected:
  [[nodiscard]] BoxedLoop random_loop() {
    std::uniform_real_distribution<double> exponent(-3.0, 0.0);
    const Eigen::VectorXd first = states(1).col(0);
    const Eigen::VectorXd second =
        first + std::pow(10.0, exponent(generator_)) * (states(1).col(0) - first);
    const Eigen::VectorXd inputs_first = inputs(1).col(0);
    const Eigen::VectorXd inputs_second = inputs(1).col(0);
    BoxedLoop loop;
    loop.lower = first.cwiseMin(second);
    loop.upper = first.cwiseMax(second);
    loop.input_lower = inputs_first.cwiseMin(inputs_second);
    loop.input_upper = inputs_first.cwiseMax(inputs_second);
    loop.gain = std::pow(10.0, exponent(generator_) + 1.0) *
                random_batch(generator_, dynamics().input_dim(), dynamics().state_dim(), 1.0);
    // Around the box the feedback crosses the bounds of the inputs.
    loop.constant = inputs_first - loop.gain * first;
    return loop;
  }
  [[nodiscard]] Eigen::VectorXd random_state_in(const BoxedLoop& loop) {
    const Eigen::ArrayXd share =
        random_batch(generator_, dynamics().state_dim(), 1, 0.5).col(0).array() + 0.5;
    return (loop.lower.array() + share * (loop.upper - loop.lower).array()).matrix();
  }
};

TEST_P(LocalLipschitzOfEverySystem, is_at_least_every_sampled_ratio) {
  for (int repetition = 0; repetition < 300; ++repetition) {
    BoxedLoop loop = random_loop();
    if (repetition % 3 == 0) loop.gain.setZero();
    const double bound = local_lipschitz(loop.derivative_bounds(dynamics()), loop.gain);
    ASSERT_TRUE(std::isfinite(bound));
    for (int pair = 0; pair < 50; ++pair) {
      const Eigen::VectorXd first = random_state_in(loop);
      const Eigen::VectorXd second = random_state_in(loop);
      const Eigen::VectorXd gap = step(first, loop.input(first)) - step(second, loop.input(second));
      // Rounding of states of order one hundred.
      EXPECT_LE(gap.norm(), bound * (second - first).norm() + 1e-12);
    }
  }
}

TEST_P(LocalLipschitzOfEverySystem, of_a_tiny_box_is_the_norm_of_the_jacobian) {
  const int dim = dynamics().state_dim();
  const Eigen::VectorXd state = states(1).col(0);
  const Eigen::VectorXd input = inputs(1).col(0);
  Eigen::VectorXd point(dim + dynamics().input_dim());
  point << state, input;
  Eigen::MatrixXd by_state(dim, dim);
  Eigen::MatrixXd by_input(dim, dynamics().input_dim());
  dynamics().jacobians(state, input, by_state, by_input);
  const double norm = by_state.jacobiSvd().singularValues()[0];
  const double bound = local_lipschitz(dynamics().derivative_bounds(point, point),
                                       Eigen::MatrixXd::Zero(dynamics().input_dim(), dim));
  EXPECT_GE(bound, norm * (1.0 - 1e-14));
  EXPECT_LE(bound, norm * (1.0 + 1e-10));  // rounding, enclosed entry by entry
}

TEST_P(LocalLipschitzOfEverySystem, unbounded_derivatives_give_infinity) {
  const double infinity = std::numeric_limits<double>::infinity();
  const DerivativeBounds unknown =
      unknown_derivative_bounds(dynamics().state_dim(), dynamics().input_dim());
  const Eigen::MatrixXd gain =
      Eigen::MatrixXd::Zero(dynamics().input_dim(), dynamics().state_dim());
  EXPECT_EQ(local_lipschitz(unknown, gain), infinity);
}

TEST_P(LocalLipschitzOfEverySystem, gain_of_another_shape_is_refused) {
  const DerivativeBounds unknown =
      unknown_derivative_bounds(dynamics().state_dim(), dynamics().input_dim());
  EXPECT_THROW((void)local_lipschitz(unknown, Eigen::MatrixXd::Zero(1, dynamics().state_dim() + 1)),
               std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(systems, LocalLipschitzOfEverySystem, ::testing::ValuesIn(system_names()));

// The entrywise enclosure does not use cos² + sin² = 1: 1.112 instead of the exact 1.078.
TEST(LocalLipschitz, of_a_car_in_any_direction_is_close_to_its_global_constant) {
  const auto car = make_dynamics("dubins", {}, kTimeStep);
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector4d lower(-infinity, -infinity, -std::numbers::pi, -2.0);
  const Eigen::Vector4d upper(infinity, infinity, std::numbers::pi, 2.0);
  const Eigen::MatrixXd open_loop = Eigen::MatrixXd::Zero(1, 3);
  const double local = local_lipschitz(car->derivative_bounds(lower, upper), open_loop);
  EXPECT_GE(local, car->lipschitz(open_loop));
  EXPECT_LE(local, 1.05 * car->lipschitz(open_loop));
}

}  // namespace local_lipschitz_test
}  // namespace qsmpc::models
