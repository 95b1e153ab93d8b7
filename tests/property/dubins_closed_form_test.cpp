// The closed form that serves as the planners' reference, checked against simulated paths and
// against cases that can be written down by hand.
#include "tests/support/dubins_closed_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace dubins_closed_form_test {

using namespace testing;

Eigen::Matrix3d correlated(double x, double y, double heading) {
  Eigen::Matrix3d root;
  root << x, 0.0, 0.0, 0.4 * y, y, 0.0, -0.7 * heading, 0.9 * heading, heading;
  return root * root.transpose();
}

/// All coordinates correlated, weights with mixed terms.
DubinsProblem general_problem() {
  Eigen::Matrix3d state;
  state << 6.0, 1.0, -0.5, 1.0, 4.0, 0.7, -0.5, 0.7, 2.0;
  DubinsProblem problem;
  problem.speed = 3.0;
  problem.time_step = 0.2;
  problem.belief = {.mean = Eigen::Vector3d(-0.5, 0.3, 0.8),
                    .covariance = correlated(0.3, 0.2, 0.25)};
  problem.noise_covariance = correlated(0.1, 0.15, 0.2);
  problem.cost = {.state = state,
                  .input = Eigen::MatrixXd::Constant(1, 1, 0.3),
                  .terminal = 2.0 * state + Eigen::Matrix3d::Identity(),
                  .target = Eigen::Vector3d(2.0, 1.0, -0.4)};
  problem.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                    .upper = Eigen::VectorXd::Constant(1, 2.0)};
  return problem;
}

/// Sum and sum of squares of draws.
struct Statistic {
  double sum = 0.0;
  double squares = 0.0;
  void add(double value) {
    sum += value;
    squares += value * value;
  }
  [[nodiscard]] double mean(int count) const { return sum / count; }
  [[nodiscard]] double standard_error(int count) const {
    return std::sqrt((squares / count - mean(count) * mean(count)) / count);
  }
};

// 6 stages with 9 moments and a cost: exceeds 4.5 standard errors once in 3,000 seeds.
constexpr double kStandardErrors = 4.5;
constexpr int kPaths = 1000000;

TEST(DubinsClosedForm, agrees_with_a_million_simulated_paths) {
  const DubinsProblem problem = general_problem();
  const Eigen::RowVectorXd inputs = (Eigen::RowVectorXd(5) << 1.5, -2.0, 0.5, 2.0, -1.0).finished();
  const Eigen::Matrix3d belief_root = problem.belief.covariance.llt().matrixL();
  const Eigen::Matrix3d noise_root = problem.noise_covariance.llt().matrixL();
  const QuadraticCost& weights = problem.cost;
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Eigen::Vector3d::NullaryExpr([&] { return normal(generator); }); };
  std::vector<std::array<Statistic, 9>> statistics(inputs.cols() + 1);
  Statistic cost;
  for (int path = 0; path < kPaths; ++path) {
    Eigen::Vector3d state = problem.belief.mean + belief_root * draw().eval();
    double path_cost = 0.0;
    for (Eigen::Index k = 0; k <= inputs.cols(); ++k) {
      const Eigen::Vector3d offset = state - weights.target;
      for (int a = 0, entry = 0; a < 3; ++a) {
        statistics[k][entry++].add(state[a]);
        for (int b = 0; b <= a; ++b) statistics[k][entry++].add(state[a] * state[b]);
      }
      if (k == inputs.cols()) {
        path_cost += offset.dot(weights.terminal * offset);
        break;
      }
      path_cost +=
          0.5 * offset.dot(weights.state * offset) + inputs[k] * weights.input(0, 0) * inputs[k];
      const double heading = state[2];
      state += Eigen::Vector3d(0.6 * std::cos(heading), 0.6 * std::sin(heading), 0.2 * inputs[k]) +
               noise_root * draw().eval();
    }
    cost.add(path_cost);
  }
  const std::vector<DubinsMoments> exact = dubins_moments(problem, inputs);
  ASSERT_EQ(exact.size(), statistics.size());
  for (std::size_t k = 0; k < exact.size(); ++k) {
    for (int a = 0, entry = 0; a < 3; ++a) {
      const Statistic& mean = statistics[k][entry++];
      EXPECT_NEAR(exact[k].mean[a], mean.mean(kPaths),
                  kStandardErrors * mean.standard_error(kPaths))
          << "stage " << k << ", mean " << a;
      for (int b = 0; b <= a; ++b) {
        const Statistic& second = statistics[k][entry++];
        EXPECT_NEAR(exact[k].second(a, b), second.mean(kPaths),
                    kStandardErrors * second.standard_error(kPaths))
            << "stage " << k << ", moment " << a << b;
        EXPECT_EQ(exact[k].second(a, b), exact[k].second(b, a));
      }
    }
  }
  EXPECT_NEAR(dubins_cost(problem, inputs).total(), cost.mean(kPaths),
              kStandardErrors * cost.standard_error(kPaths));
}

TEST(DubinsClosedForm, of_a_certain_car_is_its_path) {
  DubinsProblem problem = general_problem();
  problem.belief.covariance.setZero();
  problem.noise_covariance.setZero();
  const Eigen::RowVectorXd inputs = Eigen::RowVector4d(1.0, -0.5, 2.0, 0.0);
  Eigen::Vector3d state = problem.belief.mean;
  double cost = 0.0;
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    const Eigen::Vector3d offset = state - problem.cost.target;
    cost += 0.5 * offset.dot(problem.cost.state * offset) + 0.3 * inputs[k] * inputs[k];
    state += Eigen::Vector3d(0.6 * std::cos(state[2]), 0.6 * std::sin(state[2]), 0.2 * inputs[k]);
  }
  const Eigen::Vector3d offset = state - problem.cost.target;
  cost += offset.dot(problem.cost.terminal * offset);
  EXPECT_NEAR(dubins_cost(problem, inputs).total(), cost, 1e-12 * cost);
}

TEST(DubinsClosedForm, of_one_step_from_an_uncertain_heading_is_the_moments_of_a_wrapped_normal) {
  DubinsProblem problem = general_problem();
  constexpr double kVariance = 0.5;
  const double mean = problem.belief.mean[2];
  problem.belief.mean.head<2>().setZero();
  problem.belief.covariance = Eigen::Vector3d(0.0, 0.0, kVariance).asDiagonal();
  problem.noise_covariance.setZero();
  const DubinsMoments after = dubins_moments(problem, Eigen::MatrixXd::Constant(1, 1, 0.0)).back();
  const double reach = 0.6;
  // E cos = e^{−s/2} cos m, E cos² = (1 + e^{−2s} cos 2m) / 2, E φ sin = m E sin + s E cos.
  const double cosine = std::exp(-0.5 * kVariance) * std::cos(mean);
  const double sine = std::exp(-0.5 * kVariance) * std::sin(mean);
  const double twice = std::exp(-2.0 * kVariance);
  constexpr double kRounding = 1e-14;
  EXPECT_NEAR(after.mean[0], reach * cosine, kRounding);
  EXPECT_NEAR(after.second(0, 0), 0.5 * reach * reach * (1.0 + twice * std::cos(2.0 * mean)),
              kRounding);
  EXPECT_NEAR(after.second(0, 1), 0.5 * reach * reach * twice * std::sin(2.0 * mean), kRounding);
  EXPECT_NEAR(after.second(1, 2), reach * (mean * sine + kVariance * cosine), kRounding);
}

TEST(DubinsOptimum, is_just_below_the_least_of_a_fine_grid_of_inputs) {
  const DubinsProblem problem = general_problem();
  const DubinsOptimum optimum = dubins_optimum(problem, 3);
  constexpr int kSteps = 40;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int l = 0; l <= kSteps; ++l) {
        const Eigen::RowVector3d inputs = 4.0 / kSteps * Eigen::RowVector3d(i, j, l);
        least = std::min(least, dubins_cost(problem, inputs.array() - 2.0).total());
      }
    }
  }
  EXPECT_LE(optimum.cost, least);
  // The grid's nearest point is within 0.05 in every input, where the cost is flat.
  EXPECT_GE(optimum.cost, 0.999 * least);
  EXPECT_EQ(optimum.cost, dubins_cost(problem, optimum.inputs).total());
  EXPECT_TRUE((optimum.inputs.array().abs() <= 2.0).all());
}

}  // namespace dubins_closed_form_test
}  // namespace qsmpc::controller
