#include "harness/statistics/skewed_mean.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace skewed_mean_test {

/// exp(σ z), some of them replaced by 0.
std::vector<double> lognormal_sample(Eigen::Index count, double deviation, double zeros,
                                     std::uint64_t seed) {
  const Eigen::VectorXd z = models::standard_normal_sample(count, {.seed = seed});
  const Eigen::VectorXd u =
      models::uniform_sample(count, {.seed = seed, .stream = models::RandomStream::kSearch});
  std::vector<double> sample;
  for (Eigen::Index n = 0; n < count; ++n) {
    sample.push_back(u[n] <= zeros ? 0.0 : std::exp(deviation * z[n]));
  }
  return sample;
}

/// How many of `intervals` intervals at 99 % miss the mean.
int missed(Eigen::Index count, double deviation, double zeros, int intervals) {
  const double mean = (1.0 - zeros) * std::exp(0.5 * deviation * deviation);
  int missed = 0;
  for (int n = 0; n < intervals; ++n) {
    const RateInterval interval = skewed_mean_interval(
        lognormal_sample(count, deviation, zeros, static_cast<std::uint64_t>(n)), 0.005);
    if (mean < interval.lower || mean > interval.upper) ++missed;
  }
  return missed;
}

TEST(SkewedMean, covers_the_mean_of_a_lognormal_law) {
  // More than 35 of 2000 intervals at 99 % miss it in less than one of a thousand runs. Student's t
  // about the plain mean would miss it about 100 times.
  for (const Eigen::Index count : {5, 20, 60}) {
    for (const double deviation : {0.3, 1.0, 1.5}) {
      EXPECT_LE(missed(count, deviation, 0.0, 2000), 35) << count << " of " << deviation;
    }
  }
}

TEST(SkewedMean, covers_it_where_some_are_zero) {
  for (const double zeros : {0.05, 0.5}) EXPECT_LE(missed(20, 1.0, zeros, 2000), 35) << zeros;
}

TEST(SkewedMean, is_of_a_useful_length) {
  // Twenty numbers with a log-deviation of one: the mean is known to within a factor of about
  // three.
  const RateInterval interval = skewed_mean_interval(lognormal_sample(20, 1.0, 0.0, 1), 0.005);
  EXPECT_LT(interval.upper / interval.lower, 20.0);
  EXPECT_GT(interval.lower, 0.0);
}

TEST(SkewedMean, scales_with_the_numbers) {
  const std::vector<double> sample{1.0, 2.0, 5.0, 1.5};
  std::vector<double> scaled;
  for (const double value : sample) scaled.push_back(1e-6 * value);
  const RateInterval one = skewed_mean_interval(sample, 0.005);
  const RateInterval other = skewed_mean_interval(scaled, 0.005);
  EXPECT_NEAR(1e6 * other.lower / one.lower, 1.0, 1e-9);
  EXPECT_NEAR(1e6 * other.upper / one.upper, 1.0, 1e-9);
}

TEST(SkewedMean, knows_nothing_of_fewer_than_two_positive_numbers) {
  for (const std::vector<double>& sample :
       {std::vector<double>{}, std::vector<double>{0.0, 0.0}, std::vector<double>{0.0, 3.0}}) {
    const RateInterval interval = skewed_mean_interval(sample, 0.005);
    EXPECT_EQ(interval.lower, 0.0);
    EXPECT_TRUE(std::isinf(interval.upper));
  }
}

TEST(SkewedMean, refuses_invalid_estimates) {
  EXPECT_THROW((void)skewed_mean_interval({1.0, -1.0}, 0.005), std::invalid_argument);
  EXPECT_THROW((void)skewed_mean_interval({1.0, std::numeric_limits<double>::infinity()}, 0.005),
               std::invalid_argument);
  EXPECT_THROW((void)skewed_mean_interval({1.0, 2.0}, 0.5), std::invalid_argument);
}

}  // namespace skewed_mean_test
}  // namespace qsmpc::harness
