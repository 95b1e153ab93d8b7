// The changes of variables that keep a box: inverse and slope, for every kind of bounds.
#include "controller/planning/solvers/input_bounding.hpp"

#include <cmath>
#include <limits>
#include <ostream>
#include <random>

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace input_bounding_test {

constexpr double kNone = std::numeric_limits<double>::infinity();

// Two bounds, a narrow range far from zero, the lower one only, the upper one only, none.
const Eigen::VectorXd kLower = (Eigen::VectorXd(5) << -1.0, 40.0, 2.0, -kNone, -kNone).finished();
const Eigen::VectorXd kUpper = (Eigen::VectorXd(5) << 3.0, 40.5, kNone, -0.5, kNone).finished();

struct Kind {
  const char* name;
  InputBounding bounding;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

class ChangeOfVariables : public ::testing::TestWithParam<Kind> {
 protected:
  [[nodiscard]] Eigen::VectorXd inputs(const Eigen::VectorXd& theta) const {
    Eigen::VectorXd z(theta.size());
    bounded.inputs(theta, z);
    return z;
  }
  [[nodiscard]] bool is_penalty() const { return GetParam().bounding == InputBounding::kPenalty; }

  BoundedInputs bounded{GetParam().bounding, kLower, kUpper};
};

TEST_P(ChangeOfVariables, gives_back_inputs_that_are_not_next_to_a_bound) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0.03, 0.97);
  for (int n = 0; n < 200; ++n) {
    const Eigen::VectorXd z =
        (Eigen::VectorXd(5) << -1.0 + 4.0 * share(random), 40.0 + 0.5 * share(random),
         2.0 + 9.0 * share(random), -0.5 - 9.0 * share(random), 20.0 * share(random) - 10.0)
            .finished();
    EXPECT_TRUE(inputs(bounded.theta(z)).isApprox(z, 1e-12)) << z.transpose();
  }
}

TEST_P(ChangeOfVariables, moves_inputs_at_a_bound_inwards_so_that_the_slope_remains) {
  if (is_penalty()) {
    EXPECT_EQ(bounded.theta(kUpper), kUpper) << "there is nothing to move";
    return;
  }
  const Eigen::VectorXd lowest = (Eigen::VectorXd(5) << -1.0, 40.0, 2.0, -0.5, 0.0).finished();
  const Eigen::VectorXd highest = (Eigen::VectorXd(5) << 3.0, 40.5, 2.0, -0.5, 0.0).finished();
  for (const Eigen::VectorXd& z : {lowest, highest}) {
    const Eigen::VectorXd theta = bounded.theta(z);
    Eigen::VectorXd slope = Eigen::VectorXd::Ones(5);
    bounded.pull_back(theta, slope);
    EXPECT_GT(slope.minCoeff(), 5e-3);
    const Eigen::VectorXd moved = inputs(theta) - z;
    EXPECT_NEAR(moved.head(2).cwiseAbs().maxCoeff(), 0.02 * 4.0, 1e-12);
    EXPECT_NEAR(moved[2], 0.02, 1e-12);
    EXPECT_NEAR(moved[3], -0.02, 1e-12);
    EXPECT_EQ(moved[4], 0.0);
  }
}

TEST_P(ChangeOfVariables, has_the_slope_of_central_differences) {
  constexpr double kStep = 1e-6;
  for (const double at : {-3.0, -0.4, 0.0, 1.7, 4.0}) {
    const Eigen::VectorXd theta = Eigen::VectorXd::Constant(5, at);
    Eigen::VectorXd slope = Eigen::VectorXd::Constant(5, 2.0);
    bounded.pull_back(theta, slope);
    const Eigen::VectorXd expected =
        (inputs(theta.array() + kStep) - inputs(theta.array() - kStep)) /
        kStep;  // times 2, as the gradient
    EXPECT_TRUE(slope.isApprox(expected, 1e-6)) << slope.transpose() << "\n"
                                                << expected.transpose();
  }
}

TEST_P(ChangeOfVariables, stays_within_the_bounds_for_any_variable) {
  if (is_penalty()) return;
  for (const double at : {-1e3, -40.0, 0.0, 40.0, 1e3}) {
    const Eigen::VectorXd z = inputs(Eigen::VectorXd::Constant(5, at));
    EXPECT_TRUE((z.array() >= kLower.array()).all() && (z.array() <= kUpper.array()).all())
        << z.transpose();
  }
}

TEST_P(ChangeOfVariables,
       excess_is_zero_within_the_bounds_and_has_the_slope_of_differences_beyond) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(5);
  const Eigen::VectorXd within = (Eigen::VectorXd(5) << 3.0, 40.0, 7.0, -0.5, 1e3).finished();
  EXPECT_EQ(bounded.excess(within, 5.0, gradient), 0.0);
  EXPECT_EQ(gradient, Eigen::VectorXd::Zero(5));
  // A quarter of the range beyond the first bound, twice the range beyond the second, 3 and 0.5
  // beyond those without a range.
  const Eigen::VectorXd beyond = (Eigen::VectorXd(5) << 4.0, 39.0, -1.0, 0.0, 1e3).finished();
  EXPECT_DOUBLE_EQ(bounded.excess(beyond, 5.0, gradient), 0.0625 + 4.0 + 9.0 + 0.25);
  constexpr double kStep = 1e-6;
  Eigen::VectorXd ignored = Eigen::VectorXd::Zero(5);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(5, i);
    const double difference =
        bounded.excess(beyond + step, 0.0, ignored) - bounded.excess(beyond - step, 0.0, ignored);
    EXPECT_NEAR(gradient[i], 5.0 * difference / (2.0 * kStep), 1e-6 * std::abs(gradient[i]) + 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ChangeOfVariables,
                         ::testing::Values(Kind{"sigmoid", InputBounding::kSigmoid},
                                           Kind{"tanh", InputBounding::kTanh},
                                           Kind{"penalty", InputBounding::kPenalty}),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace input_bounding_test
}  // namespace qsmpc::controller
