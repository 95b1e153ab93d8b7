#include "harness/campaign/rare/rare_statistics.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "harness/statistics/skewed_mean.hpp"

namespace qsmpc::harness {
namespace rare_statistics_test {

RareRow row_of(double probability) {
  return {.particles = 100,
          .floor = 1e-12,
          .probability = probability,
          .collision = 0.25 * probability,
          .left_bounds = 0.75 * probability,
          .levels = 1300,
          .drives = 1400,
          .periods = 14'000,
          .plain_unsafe = 0,
          .plain_periods = 1'000,
          .certified = 1e-4};
}

RareStatistics statistics_of(const std::vector<RareRow>& rows) {
  std::vector<std::uint64_t> seeds(rows.size());
  for (std::size_t n = 0; n < seeds.size(); ++n) seeds[n] = n;
  return rare_statistics(seeds, rows);
}

TEST(RareStatistics, has_the_mean_of_the_estimates_with_their_limits) {
  const RareStatistics statistics =
      statistics_of({row_of(1e-6), row_of(3e-6), row_of(2e-6), row_of(2e-6)});
  EXPECT_DOUBLE_EQ(statistics.probability, 2e-6);
  EXPECT_DOUBLE_EQ(statistics.collision, 0.5e-6);
  EXPECT_DOUBLE_EQ(statistics.left_bounds, 1.5e-6);
  const RateInterval expected = skewed_mean_interval({1e-6, 3e-6, 2e-6, 2e-6}, 0.005);
  EXPECT_DOUBLE_EQ(statistics.interval.lower, expected.lower);
  EXPECT_DOUBLE_EQ(statistics.interval.upper, expected.upper);
  EXPECT_EQ(statistics.limits, RareLimits::kEstimates);
  EXPECT_EQ(statistics.periods, 56'000);
  EXPECT_EQ(statistics.plain_drives, 400);
}

TEST(RareStatistics, is_worth_the_plain_drives_with_the_same_variance) {
  const RareStatistics statistics =
      statistics_of({row_of(1e-6), row_of(3e-6), row_of(2e-6), row_of(2e-6)});
  // The mean of four has variance (2/3)/4 (1e-6)²; a plain drive has ten periods.
  EXPECT_NEAR(statistics.worth_drives, 2e-6 / (1e-12 / 6.0), 100.0);
  EXPECT_NEAR(statistics.worth_periods, 10.0 * statistics.worth_drives, 1e-3);
  EXPECT_NEAR(statistics.gain(), statistics.worth_periods / 56'000.0, 1e-9);
}

TEST(RareStatistics, takes_the_limits_of_plain_drives_where_runs_found_nothing) {
  RareRow none = row_of(0.0);
  none.extinct = true;
  const RareStatistics statistics = statistics_of({none, none, row_of(1e-6)});
  EXPECT_EQ(statistics.limits, RareLimits::kPlain);
  EXPECT_EQ(statistics.extinct, 2);
  EXPECT_EQ(statistics.interval.lower, 0.0);
  EXPECT_DOUBLE_EQ(statistics.interval.upper, clopper_pearson(0, 300, 0.005).upper);
}

TEST(RareStatistics, counts_an_estimate_of_zero) {
  RareRow none = row_of(0.0);
  none.extinct = true;
  const RareStatistics statistics = statistics_of({none, row_of(3e-6), row_of(1e-6), row_of(2e-6)});
  EXPECT_DOUBLE_EQ(statistics.probability, 1.5e-6);
  EXPECT_LT(statistics.interval.lower, 1.5e-6);
  EXPECT_GT(statistics.interval.upper, 1.5e-6);
}

TEST(RareStatistics, adds_what_was_given_up_at_the_floor) {
  std::vector<RareRow> rows;
  for (const double probability : {2e-6, 2.1e-6, 2.2e-6, 2.1e-6, 2e-6, 0.0}) {
    rows.push_back(row_of(probability));
  }
  const double upper = statistics_of(rows).interval.upper;
  for (RareRow& row : rows) row.floor = 1e-7;
  rows.back().below_floor = true;
  EXPECT_DOUBLE_EQ(statistics_of(rows).interval.upper, upper + 1e-7);
}

TEST(RareStatistics, holds_what_is_certified_against_what_was_found) {
  std::vector<RareRow> rows{row_of(1e-6), row_of(3e-6), row_of(2e-6), row_of(2e-6)};
  EXPECT_FALSE(statistics_of(rows).exceeds_certified());
  for (RareRow& row : rows) row.certified = 1e-9;
  EXPECT_TRUE(statistics_of(rows).exceeds_certified());
  for (RareRow& row : rows) row.certified = kNotANumber;
  EXPECT_FALSE(statistics_of(rows).exceeds_certified());
  EXPECT_TRUE(std::isnan(statistics_of(rows).certified));
}

TEST(RareStatistics, needs_a_run) {
  EXPECT_THROW((void)rare_statistics(std::vector<std::uint64_t>(), {}), std::invalid_argument);
}

}  // namespace rare_statistics_test
}  // namespace qsmpc::harness
