// The quantisers' reported distances to the Gaussian, compared with plain sampling.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "models/linear_algebra.hpp"
#include "tests/unit/controller/measure/nearest_point.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace quantiser_sampling_test {

using namespace testing;

/// √E min |x − c_n|² from samples, and its standard error.
struct Estimate {
  double w2;
  double deviation;
};

/// `points` are in the coordinates where the Gaussian is root · N(0, I).
Estimate sample_distance(const Points& points, const Eigen::MatrixXd& root, int samples,
                         Generator& generator) {
  const NearestPoint nearest(points);
  const auto dim = static_cast<int>(root.rows());
  std::normal_distribution<double> normal;
  std::array<double, 6> standard{};
  std::array<double, 6> sample{};
  double first = 0.0;
  double second = 0.0;
  for (int k = 0; k < samples; ++k) {
    for (int j = 0; j < dim; ++j) standard[j] = normal(generator);
    for (int i = 0; i < dim; ++i) {
      sample[i] = 0.0;
      for (int j = 0; j <= i; ++j) sample[i] += root(i, j) * standard[j];
    }
    const double square = nearest.squared_distance(sample.data());
    first += square;
    second += square * square;
  }
  const double mean = first / samples;
  const double variance = second / samples - mean * mean;
  return {.w2 = std::sqrt(mean),
          .deviation = 0.5 * std::sqrt(variance / samples) / std::sqrt(mean)};
}

struct Case {
  Gaussian gaussian;
  int budget;
};

/// A correlated covariance in 2 to `most_dimensions` dimensions, and a budget uniform in its
/// logarithm.
Case random_case(Generator& generator, int most_dimensions, double most_points) {
  const int dim = std::uniform_int_distribution<int>(2, most_dimensions)(generator);
  const double points = std::exp(uniform(generator, std::log(10.0), std::log(most_points)));
  return {
      .gaussian = {.mean = Eigen::VectorXd::Zero(dim), .covariance = random_spd(generator, dim)},
      .budget = static_cast<int>(std::lround(points))};
}

Eigen::MatrixXd lower_root(const Gaussian& gaussian) {
  return models::cholesky_factor(gaussian.covariance);
}

TEST(QuantiserSampling, w2_of_a_product_is_the_root_mean_square_distance_to_the_nearest_point) {
  constexpr int kSamples = 1'000'000;  // a standard error of about 0.05 %
  Generator generator(51);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const auto [gaussian, budget] = random_case(generator, 6, 1000.0);
    const GaussianQuantisation quantised = quantise(gaussian, budget);
    const Estimate estimate =
        sample_distance(quantised.measure.locations, lower_root(gaussian), kSamples, generator);
    EXPECT_NEAR(quantised.w2, estimate.w2, 0.01 * estimate.w2)
        << gaussian.mean.size() << " dimensions, " << budget << " points";
    EXPECT_NEAR(quantised.w2, estimate.w2, 5.0 * estimate.deviation);
  }
}

TEST(QuantiserSampling, w2_of_spread_points_is_a_bound_and_not_far_from_the_distance) {
  constexpr int kSamples = 200'000;
  Generator generator(52);
  for (int repetition = 0; repetition < 6; ++repetition) {
    const auto [gaussian, budget] = random_case(generator, 4, 100.0);
    const GaussianQuantisation quantised = quantise(gaussian, budget, QuantiserKind::kLloyd);
    const Estimate estimate =
        sample_distance(quantised.measure.locations, lower_root(gaussian), kSamples, generator);
    EXPECT_GE(quantised.w2, estimate.w2 - 5.0 * estimate.deviation);
    EXPECT_LE(quantised.w2, 1.15 * estimate.w2)
        << gaussian.mean.size() << " dimensions, " << budget << " points";
  }
}

}  // namespace quantiser_sampling_test
}  // namespace qsmpc::controller
