#include "harness/statistics/quantiles.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "harness/statistics/sample_statistics.hpp"

namespace qsmpc::harness {
namespace quantiles_test {

TEST(SortedQuantiles, are_the_values_at_the_nearest_ranks) {
  SortedQuantiles quantiles(10, {0.0, 0.05, 0.1, 0.11, 0.5, 0.95, 1.0});
  for (int i = 1; i <= 10; ++i) quantiles.add(i);
  EXPECT_EQ(quantiles.values(), (std::vector<double>{1, 1, 1, 2, 5, 10, 10}));
}

TEST(SortedQuantiles, a_value_may_stand_for_many) {
  SortedQuantiles quantiles(6, {0.0, 0.5, 0.6, 1.0});
  quantiles.add(-std::numeric_limits<double>::infinity(), 3);
  quantiles.add(7.0, 3);
  EXPECT_EQ(quantiles.values()[1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(quantiles.values()[2], 7.0);
  EXPECT_EQ(quantiles.values()[3], 7.0);
}

TEST(SortedQuantiles, of_nothing_are_not_numbers) {
  const SortedQuantiles quantiles(0, {0.0, 0.5, 1.0});
  for (const double value : quantiles.values()) EXPECT_TRUE(std::isnan(value));
}

TEST(SortedQuantiles, refuse_impossible_arguments) {
  EXPECT_THROW(SortedQuantiles(-1, {0.5}), std::invalid_argument);
  EXPECT_THROW(SortedQuantiles(1, {0.5, 0.4}), std::invalid_argument);
  EXPECT_THROW(SortedQuantiles(1, {1.1}), std::invalid_argument);
}

TEST(SortedDistribution, has_the_figures_of_a_summary) {
  SortedDistribution distribution(200);
  for (int i = 1; i <= 200; ++i) distribution.add(i);
  const Distribution result = distribution.result();
  EXPECT_EQ(result.median, 100.0);
  EXPECT_EQ(result.p95, 190.0);
  EXPECT_EQ(result.p99, 198.0);
  EXPECT_EQ(result.max, 200.0);
  EXPECT_DOUBLE_EQ(result.mean, 100.5);
  EXPECT_TRUE(std::isnan(SortedDistribution(0).result().mean));
}

TEST(DistributionOrZeros, takes_a_sample_in_any_order) {
  const Distribution result = distribution_or_zeros({3.0, 1.0, 5.0, 2.0});
  EXPECT_EQ(result.median, 2.0);
  EXPECT_EQ(result.p99, 5.0);
  EXPECT_EQ(result.max, 5.0);
  EXPECT_EQ(result.mean, 2.75);
}

TEST(DistributionOrZeros, of_nothing_is_zero) {
  const Distribution result = distribution_or_zeros({});
  for (const double value : {result.median, result.p95, result.p99, result.max, result.mean}) {
    EXPECT_EQ(value, 0.0);
  }
}

TEST(RunningMean, is_that_of_the_whole_sample_also_far_from_zero) {
  std::vector<double> sample;
  RunningMean running;
  for (int i = 0; i < 100; ++i) {
    sample.push_back(1e6 + std::sin(i));
    running.add(sample.back());
  }
  EXPECT_NEAR(running.mean(), mean_of(sample), 1e-8);  // rounding of sums of 1e8
  EXPECT_NEAR(running.standard_error(), standard_error_of(sample), 1e-9);
  EXPECT_EQ(running.count(), 100);
}

TEST(RunningMean, is_nan_where_unknown) {
  RunningMean running;
  EXPECT_TRUE(std::isnan(running.mean()));
  running.add(1.0);
  EXPECT_EQ(running.mean(), 1.0);
  EXPECT_TRUE(std::isnan(running.standard_error()));
}

}  // namespace quantiles_test
}  // namespace qsmpc::harness
