// Requirements on every system of the table, so that new ones are tested once listed.
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace every_system_test {

using namespace testing;

// Central differences with step h have the error h² |f'''|/6 + ε |f|/h: about 1e-10 for values of
// order ten; a hundred times that is allowed.
constexpr double kDifferenceStep = 1e-5;
constexpr double kDifferenceTolerance = 1e-8;
// Two ways of computing the same products and sums of values of order ten.
constexpr double kRounding = 1e-13;
// Systems without a global Lipschitz constant; local_lipschitz_test compares their constants on a
// region with samples.
const std::set<std::string> kWithoutConstant = {"bicycle",
                                                "cart_pole",
                                                "every_function",
                                                "lag_unicycle",
                                                "lag_unicycle_by_equations",
                                                "planar_quadrotor",
                                                "planar_quadrotor_by_equations"};

TEST_P(EverySystem, description_is_complete_and_consistent) {
  const SystemDescription& system = dynamics().description();
  EXPECT_EQ(system.name, GetParam());
  EXPECT_FALSE(system.summary.empty());
  EXPECT_EQ(dynamics().state_dim(), static_cast<int>(system.states.size()));
  EXPECT_EQ(dynamics().input_dim(), static_cast<int>(system.inputs.size()));
  ASSERT_EQ(system.input_lower.size(), dynamics().input_dim());
  ASSERT_EQ(system.input_upper.size(), dynamics().input_dim());
  EXPECT_TRUE((system.input_lower.array() < system.input_upper.array()).all());
  for (const int index : {system.position_x, system.position_y, system.heading}) {
    EXPECT_GE(index, -1);
    EXPECT_LT(index, dynamics().state_dim());
  }
  for (int i = 0; i < dynamics().state_dim(); ++i) {
    EXPECT_EQ(system.state_index(system.states[i].name), i) << "state names must be unique";
    EXPECT_FALSE(system.states[i].unit.empty());
  }
  EXPECT_EQ(system.state_index("no such state"), -1);
}

TEST_P(EverySystem, batch_step_equals_the_step_of_each_column) {
  const StateBatch state = states(37);
  const StateBatch input = inputs(37);
  const StateBatch next = step(state, input);
  for (Eigen::Index i = 0; i < state.cols(); ++i) {
    const StateBatch single = step(state.col(i), input.col(i));
    EXPECT_LE((next.col(i) - single.col(0)).cwiseAbs().maxCoeff(), kRounding) << "column " << i;
  }
}

TEST_P(EverySystem, jacobians_equal_central_differences) {
  for (int repetition = 0; repetition < 50; ++repetition) {
    const StateBatch state = states(1);
    const StateBatch input = inputs(1);
    const Eigen::Index dim = state.rows();
    Eigen::MatrixXd by_state = Eigen::MatrixXd::Constant(dim, dim, std::nan(""));
    Eigen::MatrixXd by_input = Eigen::MatrixXd::Constant(dim, input.rows(), std::nan(""));
    dynamics().jacobians(state.col(0), input.col(0), by_state, by_input);
    for (Eigen::Index axis = 0; axis < dim; ++axis) {
      StateBatch high = state;
      StateBatch low = state;
      high(axis, 0) += kDifferenceStep;
      low(axis, 0) -= kDifferenceStep;
      const Eigen::VectorXd slope =
          (step(high, input) - step(low, input)).col(0) / (2.0 * kDifferenceStep);
      EXPECT_LE((by_state.col(axis) - slope).cwiseAbs().maxCoeff(), kDifferenceTolerance);
    }
    for (Eigen::Index axis = 0; axis < input.rows(); ++axis) {
      StateBatch high = input;
      StateBatch low = input;
      high(axis, 0) += kDifferenceStep;
      low(axis, 0) -= kDifferenceStep;
      const Eigen::VectorXd slope =
          (step(state, high) - step(state, low)).col(0) / (2.0 * kDifferenceStep);
      EXPECT_LE((by_input.col(axis) - slope).cwiseAbs().maxCoeff(), kDifferenceTolerance);
    }
  }
}

TEST_P(EverySystem, pullback_is_the_transposed_jacobian_and_overwrites) {
  const Eigen::Index count = 23;
  const Eigen::Index dim = dynamics().state_dim();
  const Eigen::Index input_dim = dynamics().input_dim();
  const StateBatch state = states(count);
  const StateBatch input = inputs(count);
  const StateBatch adjoint = random_batch(generator_, dim, count, 3.0);
  StateBatch state_adjoint = StateBatch::Constant(dim, count, std::nan(""));
  StateBatch input_adjoint = StateBatch::Constant(input_dim, count, std::nan(""));
  dynamics().pullback(state, input, adjoint, state_adjoint, input_adjoint);
  Eigen::MatrixXd by_state(dim, dim);
  Eigen::MatrixXd by_input(dim, input_dim);
  for (Eigen::Index i = 0; i < count; ++i) {
    dynamics().jacobians(state.col(i), input.col(i), by_state, by_input);
    const Eigen::VectorXd expected_state = by_state.transpose() * adjoint.col(i);
    const Eigen::VectorXd expected_input = by_input.transpose() * adjoint.col(i);
    EXPECT_LE((state_adjoint.col(i) - expected_state).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LE((input_adjoint.col(i) - expected_input).cwiseAbs().maxCoeff(), kRounding);
  }
}

/// A random closed loop x ↦ f(x, clamp(v + K (x − x̄))) with bounds tight enough to saturate often.
struct ClosedLoop {
  Eigen::MatrixXd gain;
  Eigen::VectorXd constant;
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;

  [[nodiscard]] Eigen::VectorXd input(const Eigen::VectorXd& state) const {
    return (constant + gain * state).cwiseMax(lower).cwiseMin(upper);
  }
};

TEST_P(EverySystem, lipschitz_constant_is_at_least_every_sampled_ratio) {
  std::uniform_real_distribution<double> exponent(-6.0, 0.5);
  const Eigen::Index dim = dynamics().state_dim();
  const Eigen::Index input_dim = dynamics().input_dim();
  for (int repetition = 0; repetition < 300; ++repetition) {
    const double size = std::pow(10.0, exponent(generator_) / 2.0);
    ClosedLoop loop;
    loop.gain = 10.0 * size * random_batch(generator_, input_dim, dim, 1.0);
    if (repetition % 4 == 0) loop.gain.setZero();
    loop.constant = random_batch(generator_, input_dim, 1, 2.0);
    loop.lower = random_batch(generator_, input_dim, 1, 1.0).array() - 1.0;
    loop.upper = loop.lower.array() + 1.0 + std::pow(10.0, exponent(generator_) + 2.0);
    const double bound = dynamics().lipschitz(loop.gain);
    // With an infinite bound the comparison below could not fail.
    EXPECT_EQ(std::isinf(bound), kWithoutConstant.contains(GetParam())) << loop.gain;
    for (int pair = 0; pair < 50; ++pair) {
      const Eigen::VectorXd first = states(1).col(0);
      const double distance = std::pow(10.0, exponent(generator_));
      const Eigen::VectorXd second =
          first + distance * random_batch(generator_, dim, 1, 1.0).col(0).normalized();
      const Eigen::VectorXd gap = step(first, loop.input(first)) - step(second, loop.input(second));
      // Rounding of states of order ten, compared with distances down to 1e-6.
      EXPECT_LE(gap.norm(), bound * (second - first).norm() + kRounding);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(systems, EverySystem, ::testing::ValuesIn(system_names()));

}  // namespace every_system_test
}  // namespace qsmpc::models
