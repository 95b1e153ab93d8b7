#include "harness/campaign/statistics/paired_difference.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace paired_difference_test {

EpisodeRow row(std::uint64_t seed, const std::string& outcome, double cost,
               double clearance = 0.3) {
  EpisodeRow result;
  result.seed = seed;
  result.outcome = outcome;
  result.cost = cost;
  result.min_clearance = clearance;
  result.unsafe = clearance <= 0.0;
  result.steps = 10;
  result.next_step_sum = 0.1;
  return result;
}

MeanDifference difference_of(const std::vector<MeanDifference>& differences,
                             const std::string& quantity) {
  for (const MeanDifference& difference : differences) {
    if (difference.quantity == quantity) return difference;
  }
  throw std::invalid_argument("no such quantity: " + quantity);
}

TEST(PoissonWeights, have_the_law_of_a_poisson_number_of_mean_one) {
  constexpr int kPairs = 500;
  Eigen::ArrayXd weights;
  Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(9);
  for (std::uint64_t seed = 0; seed < kPairs; ++seed) {
    poisson_weights(seed, weights);
    ASSERT_EQ(weights.size(), kBootstrapReplicates);
    for (const double weight : weights) counts[static_cast<Eigen::Index>(weight)] += 1.0;
  }
  const double draws = static_cast<double>(kPairs) * kBootstrapReplicates;
  double probability = std::exp(-1.0);
  for (int k = 0; k < 9; ++k) {
    // Five standard deviations of a binomial count, plus rounding by half a 16-bit step.
    const double tolerance = 5.0 * std::sqrt(probability / draws) + 0.5 / 65536.0;
    EXPECT_NEAR(counts[k] / draws, probability, tolerance) << k;
    probability /= k + 1;
  }
}

TEST(PoissonWeights, depend_on_the_seed_alone_and_differ_between_replicates_and_seeds) {
  Eigen::ArrayXd first;
  Eigen::ArrayXd again;
  Eigen::ArrayXd other;
  poisson_weights(7, first);
  poisson_weights(8, other);
  poisson_weights(7, again);
  EXPECT_TRUE((first == again).all());
  const auto correlation = [](const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
    return ((a - 1.0) * (b - 1.0)).mean();
  };
  // Five standard deviations of a mean of products of independent numbers with variance 1.
  const double tolerance = 5.0 / std::sqrt(kBootstrapReplicates);
  EXPECT_NEAR(correlation(first, other), 0.0, tolerance);
  for (const int lag : {1, 4, 16}) {
    const Eigen::Index rest = kBootstrapReplicates - lag;
    EXPECT_NEAR(correlation(first.head(rest), first.tail(rest)), 0.0, tolerance) << lag;
  }
}

TEST(PairedDifference, is_to_the_last_bit_the_bootstrap_of_each_quantity_alone) {
  PairedDifference difference;
  BootstrapMean cost;
  BootstrapMean reached;
  Eigen::ArrayXd weights;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const EpisodeRow before = row(seed, seed % 7 == 0 ? "fault" : "reached",
                                  10.0 + 0.1 * static_cast<double>(seed * seed % 13));
    const EpisodeRow after =
        row(seed, seed % 5 == 0 ? "timeout" : "reached", seed % 4 == 0 ? before.cost : 11.3);
    poisson_weights(seed, weights);
    difference.add(before, after, weights);
    if (seed % 7 != 0) cost.add(after.cost - before.cost, weights);
    reached.add(
        (after.outcome == "reached" ? 1.0 : 0.0) - (before.outcome == "reached" ? 1.0 : 0.0),
        weights);
  }
  const std::vector<MeanDifference> result = difference.result();
  for (const auto& [name, alone] : {std::pair{"cost", &cost}, std::pair{"reached", &reached}}) {
    const MeanDifference together = difference_of(result, name);
    EXPECT_EQ(together.pairs, alone->count());
    EXPECT_EQ(together.mean, alone->mean());
    EXPECT_EQ(together.interval.lower, alone->interval().lower);
    EXPECT_EQ(together.interval.upper, alone->interval().upper);
  }
}

TEST(PairedDifference, is_the_mean_over_the_pairs) {
  PairedDifference difference;
  difference.add(row(0, "reached", 10.0, 0.5), row(0, "reached", 13.0, 0.4));
  difference.add(row(1, "timeout", 10.0, 0.5), row(1, "reached", 9.0, 0.5));
  difference.add(row(2, "reached", 10.0, 0.5), row(2, "collision", 14.0, -0.1));
  const std::vector<MeanDifference> result = difference.result();
  const MeanDifference cost = difference_of(result, "cost");
  EXPECT_DOUBLE_EQ(cost.mean, 2.0);
  EXPECT_EQ(cost.pairs, 3);
  EXPECT_EQ(cost.higher, 2);
  EXPECT_EQ(cost.lower, 1);
  EXPECT_LE(cost.interval.lower, 2.0);
  EXPECT_GE(cost.interval.upper, 2.0);
  EXPECT_DOUBLE_EQ(difference_of(result, "reached").mean, 0.0);
  EXPECT_DOUBLE_EQ(difference_of(result, "unsafe").mean, 1.0 / 3.0);
  EXPECT_NEAR(difference_of(result, "min_clearance").mean, -0.7 / 3.0, 1e-15);  // rounding
}

TEST(PairedDifference, a_fault_leaves_its_pair_out_where_it_has_no_number_but_not_of_the_outcomes) {
  PairedDifference difference;
  difference.add(row(0, "reached", 10.0), row(0, "reached", 11.0));
  difference.add(row(1, "reached", 10.0), row(1, "fault", 1.0));
  difference.add(row(2, "fault", 0.0), row(2, "reached", 11.0));
  difference.add(row(3, "reached", 10.0), row(3, "fault", 1.0));
  const std::vector<MeanDifference> result = difference.result();
  EXPECT_EQ(difference_of(result, "cost").pairs, 1);
  EXPECT_EQ(difference_of(result, "cost").left_out, 3);
  EXPECT_DOUBLE_EQ(difference_of(result, "cost").mean, 1.0);
  EXPECT_EQ(difference_of(result, "min_clearance").left_out, 3);
  EXPECT_EQ(difference_of(result, "reached").pairs, 4);
  EXPECT_EQ(difference_of(result, "reached").left_out, 0);
  EXPECT_DOUBLE_EQ(difference_of(result, "reached").mean, -0.25);
}

TEST(PairedDifference, of_one_pair_or_of_none_has_no_interval) {
  PairedDifference difference;
  EXPECT_TRUE(std::isnan(difference_of(difference.result(), "cost").mean));
  difference.add(row(0, "reached", 10.0), row(0, "reached", 11.0));
  const MeanDifference cost = difference_of(difference.result(), "cost");
  EXPECT_EQ(cost.mean, 1.0);
  EXPECT_TRUE(std::isnan(cost.interval.lower));
  EXPECT_TRUE(std::isnan(cost.interval.upper));
}

TEST(PairedDifference, an_episode_without_a_step_has_no_certificate_to_compare) {
  PairedDifference difference;
  EpisodeRow at_target = row(0, "reached", 0.0);
  at_target.steps = 0;
  difference.add(row(0, "reached", 1.0), at_target);
  EXPECT_EQ(difference_of(difference.result(), "certified").left_out, 1);
  EXPECT_EQ(difference_of(difference.result(), "cost").left_out, 0);
}

TEST(PairedDifference, does_not_depend_on_the_order_of_the_pairs) {
  PairedDifference forwards;
  PairedDifference backwards;
  constexpr int kPairs = 50;
  for (int n = 0; n < kPairs; ++n) {
    for (const auto& [target, i] : {std::pair{&forwards, n}, {&backwards, kPairs - 1 - n}}) {
      const auto seed = static_cast<std::uint64_t>(i);
      target->add(row(seed, "reached", 10.0), row(seed, "reached", 10.0 + std::sin(i)));
    }
  }
  const MeanDifference first = difference_of(forwards.result(), "cost");
  const MeanDifference second = difference_of(backwards.result(), "cost");
  EXPECT_NEAR(first.interval.lower, second.interval.lower, 1e-13);  // rounding of sums
  EXPECT_NEAR(first.interval.upper, second.interval.upper, 1e-13);
}

BootstrapMean bootstrapped(const Eigen::VectorXd& sample, std::uint64_t first_seed) {
  BootstrapMean mean;
  Eigen::ArrayXd weights;
  for (Eigen::Index i = 0; i < sample.size(); ++i) {
    poisson_weights(first_seed + static_cast<std::uint64_t>(i), weights);
    mean.add(sample[i], weights);
  }
  return mean;
}

TEST(BootstrapMean, has_the_interval_of_a_normal_sample) {
  constexpr int kSize = 4000;
  const Eigen::VectorXd sample =
      (3.0 + 2.0 * models::standard_normal_sample(kSize, {.seed = 5}).array()).matrix();
  const BootstrapMean mean = bootstrapped(sample, 0);
  const double deviation = std::sqrt((sample.array() - sample.mean()).square().mean() / kSize);
  const double quantile = boost::math::quantile(boost::math::normal(), 1.0 - kCampaignTail);
  // The 10th of 2000 values lies between the quantiles of 0.2 % and 0.95 % (2σ of its rank): within
  // 0.25 standard deviations of the 0.5 % quantile.
  EXPECT_NEAR(mean.interval().lower, sample.mean() - quantile * deviation, 0.3 * deviation);
  EXPECT_NEAR(mean.interval().upper, sample.mean() + quantile * deviation, 0.3 * deviation);
  EXPECT_NEAR(mean.mean(), sample.mean(), 1e-12);  // rounding of the sum
}

// Skewed numbers, like costs: exponential with mean 1. The percentile interval of 300 of them
// misses the mean in 1.3 % of many samples instead of 1 %, because of their skewness; 14 of 400
// would be almost four standard deviations above that.
TEST(BootstrapMean, has_an_interval_that_covers_the_true_mean) {
  constexpr int kSamples = 400;
  constexpr int kSize = 300;
  int missed = 0;
  for (std::uint64_t n = 0; n < kSamples; ++n) {
    const Eigen::VectorXd sample =
        -models::uniform_sample(kSize, {.seed = 11, .episode = n}).array().log().matrix();
    const RateInterval interval = bootstrapped(sample, n * kSize).interval();
    missed += interval.lower > 1.0 || interval.upper < 1.0 ? 1 : 0;
  }
  EXPECT_LE(missed, 14);
  EXPECT_GE(missed, 1) << "an interval that is never wrong is too wide";
}

}  // namespace paired_difference_test
}  // namespace qsmpc::harness
