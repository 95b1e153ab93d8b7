// The sampled prices that are the planners' reference: correct values and gradients, true minima.
#include "tests/support/policy_search.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/planning_quality.hpp"

namespace qsmpc::controller {
namespace policy_search_test {

using namespace testing;

Eigen::MatrixXd wavy_inputs(int rows, int horizon) {
  return Eigen::MatrixXd::NullaryExpr(rows, horizon, [](Eigen::Index row, Eigen::Index k) {
    return 0.3 * std::sin(1.0 + static_cast<double>(k + 3 * row));
  });
}

/// Compares the analytic gradient of the price with central differences.
void expect_slope(SampledProblem& problem, const Eigen::MatrixXd& inputs) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd gradient(inputs.rows(), inputs.cols());
  const double price = problem.evaluate(inputs, gradient);
  EXPECT_EQ(price, problem.evaluate(inputs));
  Eigen::MatrixXd differences = gradient;
  Eigen::MatrixXd moved = inputs;
  for (Eigen::Index i = 0; i < inputs.size(); ++i) {
    moved.data()[i] = inputs.data()[i] + kStep;
    const double above = problem.evaluate(moved);
    moved.data()[i] = inputs.data()[i] - kStep;
    differences.data()[i] = (above - problem.evaluate(moved)) / (2.0 * kStep);
    moved.data()[i] = inputs.data()[i];
  }
  // The few paths that reach a kink of clamp or penalty within the short step.
  EXPECT_LT((gradient - differences).norm(), 1e-4 * gradient.norm()) << gradient << "\n\n"
                                                                     << differences;
}

TEST(SampledProblem, gives_the_slope_of_the_price_among_blocks) {
  const std::unique_ptr<const models::Dynamics> car = default_car();
  SampledProblem problem(*car, blocks_settings(10), later_belief(1.2, 1.4, 0.7),
                         {.paths = 200, .seed = 3});
  expect_slope(problem, wavy_inputs(1, 10));
}

TEST(SampledProblem, gives_the_slope_of_the_price_of_two_inputs_and_a_given_gain) {
  const auto bicycle = models::make_dynamics("bicycle", {}, 0.1);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(6);
  mean[3] = 5.0;
  PlannerSettings settings;
  settings.horizon = 6;
  settings.noise_covariance = 0.001 * Eigen::MatrixXd::Identity(6, 6);
  settings.cost = {.state = Eigen::MatrixXd::Identity(6, 6),
                   .input = Eigen::Vector2d(0.1, 0.2).asDiagonal(),
                   .terminal = 2.0 * Eigen::MatrixXd::Identity(6, 6),
                   .target = mean};
  settings.safe_set = unbounded_safe_set(6);
  settings.safe_set.bounds.upper[1] = 0.3;
  settings.bounds = {.lower = Eigen::Vector2d(-5.0, -0.7), .upper = Eigen::Vector2d(2.0, 0.7)};
  for (const bool lqr : {true, false}) {
    if (!lqr) settings.feedback_gain = Eigen::MatrixXd::Constant(2, 6, -0.1);
    SampledProblem problem(*bicycle, settings,
                           {.mean = mean, .covariance = 0.001 * Eigen::MatrixXd::Identity(6, 6)},
                           {.paths = 100, .seed = 4});
    expect_slope(problem, wavy_inputs(2, 6));
  }
}

TEST(SampledProblem, prices_an_open_loop_as_the_closed_form_does) {
  const std::unique_ptr<const models::Dynamics> car = default_car();
  const PlannerSettings settings = free_settings(12, /*closed_loop=*/false);
  const Gaussian belief = first_belief(5.0, 4.0, 0.5);
  SampledProblem problem(*car, settings, belief, {.paths = 200000, .seed = 5});
  const Eigen::MatrixXd inputs = wavy_inputs(1, 12);
  const double exact = dubins_cost(closed_form_of(settings, belief), inputs).total();
  // A standard deviation of 15 % over 200,000 paths: four standard errors.
  EXPECT_NEAR(problem.evaluate(inputs), exact, 1.3e-3 * exact);
}

TEST(SampledProblem, descends_to_the_optimum_of_the_closed_form) {
  const std::unique_ptr<const models::Dynamics> car = default_car();
  const PlannerSettings settings = free_settings(8, /*closed_loop=*/false);
  const Gaussian belief = first_belief(0.0, 0.0, 0.0);
  SampledProblem problem(*car, settings, belief, {.paths = 4000, .seed = 6});
  const Eigen::MatrixXd inputs = problem.descend(Eigen::MatrixXd::Zero(1, 8));
  const DubinsProblem exact = closed_form_of(settings, belief);
  EXPECT_NEAR(dubins_cost(exact, inputs).total(), dubins_optimum(exact, 8).cost, 0.1);
}

}  // namespace policy_search_test
}  // namespace qsmpc::controller
