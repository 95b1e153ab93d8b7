// Weights, temperatures and risks of samples, compared with their definitions.
#include "controller/control/mppi/sample_weights.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "controller/control/mppi/input_smoothing.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace sample_weights_test {

constexpr double kRounding = 1e-12;

Eigen::ArrayXd random_numbers(Eigen::Index count, double scale, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::exponential_distribution<double> number(1.0 / scale);
  Eigen::ArrayXd values(count);
  for (double& value : values) value = number(generator);
  return values;
}

TEST(SampleWeights, are_exponentials_of_cost_and_tilt) {
  Eigen::ArrayXd cost = random_numbers(300, 40.0, 1);
  const Eigen::ArrayXd tilt = random_numbers(300, 0.7, 2);
  cost[17] = kInfinity;
  constexpr double kTemperature = 25.0;
  Eigen::ArrayXd weights(300);
  const double effective = softmin_weights({cost, tilt}, kTemperature, weights);
  Eigen::ArrayXd expected = (-cost / kTemperature - tilt).exp();
  expected[17] = 0.0;
  expected /= expected.sum();
  EXPECT_LE((weights - expected).abs().maxCoeff(), kRounding);
  EXPECT_EQ(weights[17], 0.0);
  EXPECT_NEAR(effective, 1.0 / expected.square().sum(), 1e-9 * effective);
}

// Costs so large that their exponentials underflow: only differences count.
TEST(SampleWeights, depend_on_differences_of_costs_alone) {
  const Eigen::ArrayXd cost = random_numbers(50, 3.0, 3);
  const Eigen::ArrayXd tilt = Eigen::ArrayXd::Zero(50);
  Eigen::ArrayXd weights(50);
  Eigen::ArrayXd shifted(50);
  (void)softmin_weights({cost, tilt}, 2.0, weights);
  (void)softmin_weights({cost + 1e6, tilt}, 2.0, shifted);
  // Adding 1e6 rounds costs to 1e-10.
  EXPECT_LE((weights - shifted).abs().maxCoeff(), 1e-9);
}

TEST(SampleWeights, of_samples_without_a_finite_cost_are_zero) {
  const Eigen::ArrayXd cost = Eigen::ArrayXd::Constant(4, kInfinity);
  Eigen::ArrayXd weights(4);
  EXPECT_EQ(softmin_weights({cost, Eigen::ArrayXd::Zero(4)}, 1.0, weights), 0.0);
  EXPECT_TRUE(weights.isZero(0.0));
}

TEST(SampleWeights, effective_temperature_leaves_the_wanted_number_of_samples) {
  Eigen::ArrayXd cost = random_numbers(1000, 500.0, 4);
  // A few collisions must not determine the temperature among the others.
  cost.head(100) += 1e9;
  const Eigen::ArrayXd tilt = Eigen::ArrayXd::Zero(1000);
  Eigen::ArrayXd weights(1000);
  for (const double wanted : {5.0, 50.0, 400.0}) {
    const double temperature = effective_temperature({cost, tilt}, wanted, weights);
    EXPECT_NEAR(softmin_weights({cost, tilt}, temperature, weights), wanted, 0.02 * wanted);
  }
  const Eigen::ArrayXd same = Eigen::ArrayXd::Constant(1000, 7.0);
  EXPECT_GT(effective_temperature({same, tilt}, 50.0, weights), 0.0);
}

/// min_z z + E(X − z)₊ / (1 − α): piecewise linear, so the minimum is at one of the values.
double defined_risk(const std::vector<double>& values, double level) {
  double least = kInfinity;
  for (const double z : values) {
    double excess = 0.0;
    for (const double x : values) excess += std::max(x - z, 0.0);
    const auto count = static_cast<double>(values.size());
    least = std::min(least, z + excess / count / (1.0 - level));
  }
  return least;
}

TEST(ConditionalValueAtRisk, is_the_minimum_that_defines_it) {
  for (const Eigen::Index count : {1, 2, 7, 16, 40}) {
    const Eigen::ArrayXd numbers = random_numbers(count, 3.0, static_cast<unsigned>(count));
    const std::vector<double> values(numbers.begin(), numbers.end());
    for (const double level : {0.0, 0.33, 0.5, 0.9, 0.95, 0.999}) {
      std::vector<double> scratch = values;
      const double expected = defined_risk(values, level);
      EXPECT_NEAR(conditional_value_at_risk(scratch, level), expected, 1e-9 * expected)
          << count << " values, level " << level;
    }
  }
  std::vector<double> four = {1.0, 4.0, 2.0, 3.0};
  EXPECT_DOUBLE_EQ(conditional_value_at_risk(four, 0.5), 3.5);
  EXPECT_DOUBLE_EQ(conditional_value_at_risk(four, 0.0), 2.5);
}

TEST(InputSmoothing, keeps_parabolas_and_averages_fluctuations) {
  constexpr int kHalf = 3;
  constexpr int kHorizon = 15;
  InputSmoothing smoothing(kHalf, Eigen::VectorXd::Zero(1));
  Eigen::MatrixXd inputs(1, kHorizon);
  for (int k = 0; k < kHorizon; ++k) inputs(0, k) = 0.3 * k * k - 2.0 * k + 1.0;
  const Eigen::MatrixXd parabola = inputs;
  smoothing.smooth(inputs);
  // Inputs whose windows reach neither the held last input nor the inputs before the drive.
  for (int k = kHalf; k + kHalf < kHorizon; ++k) {
    EXPECT_NEAR(inputs(0, k), parabola(0, k), 1e-9) << k;
  }
  for (int k = 0; k < kHorizon; ++k) inputs(0, k) = k % 2 == 0 ? 1.0 : -1.0;
  smoothing.smooth(inputs);
  EXPECT_LT(inputs.middleCols(kHalf, kHorizon - 2 * kHalf).cwiseAbs().maxCoeff(), 0.5);
}

TEST(InputSmoothing, includes_the_inputs_applied_before) {
  InputSmoothing smoothing(2, Eigen::VectorXd::Zero(1));
  const auto first_of = [&] {
    Eigen::MatrixXd inputs = Eigen::MatrixXd::Ones(1, 6);
    smoothing.smooth(inputs);
    return inputs(0, 0);
  };
  EXPECT_LT(first_of(), 0.9);
  for (int n = 0; n < 2; ++n) smoothing.note_applied(Eigen::VectorXd::Ones(1));
  EXPECT_NEAR(first_of(), 1.0, kRounding);
  smoothing.reset();
  EXPECT_LT(first_of(), 0.9);
}

}  // namespace sample_weights_test
}  // namespace qsmpc::controller
