// Rows and claims from drives: medians, shares, and differences for the same seeds.

#include "harness/reproduction/drive_rows.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/statistics/sample_statistics.hpp"

namespace qsmpc::harness {
namespace drive_rows_test {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

EpisodeDigest drive(double duration, bool arrived, bool unsafe, std::vector<double> certified) {
  EpisodeDigest digest{.arrived = arrived, .unsafe = unsafe, .duration = duration};
  digest.optimisation_s = 2.0 * duration;
  digest.inputs = Eigen::MatrixXd::Zero(1, static_cast<Eigen::Index>(certified.size()));
  digest.published = certified;
  digest.particles = certified;
  digest.next_step = std::move(certified);
  return digest;
}

Sample example() {
  Sample sample;
  sample.episodes = {drive(1.0, true, false, {0.1, 0.3}), drive(3.0, true, true, {0.5, 0.2}),
                     drive(9.0, false, false, {0.2, 0.2}), drive(2.0, true, false, {0.4, 0.0})};
  return sample;
}

const ResultRow& row_called(const ExperimentResult& result, const std::string& part) {
  for (const ResultRow& row : result.rows) {
    if (row.quantity.find(part) != std::string::npos) return row;
  }
  throw std::runtime_error("no row has " + part);
}

TEST(DriveRows, count_arrivals_that_were_never_unsafe) {
  EXPECT_EQ(safe_arrivals(example()), 2);
  ExperimentResult result;
  add_drive_rows({.name = "a", .variant = {}}, example(), result);
  EXPECT_DOUBLE_EQ(row_called(result, "never unsafe").here, 0.5);
  EXPECT_EQ(row_called(result, "never unsafe").note, "2 of 4 (50 %)");
}

TEST(DriveRows, take_times_of_those_that_arrived_alone) {
  EXPECT_THAT(arrival_times(example()), ElementsAre(1.0, 3.0, 2.0));
  ExperimentResult result;
  add_drive_rows({.name = "a", .variant = {}, .reached_s = 4.0}, example(), result);
  const ResultRow& row = row_called(result, "target reached");
  EXPECT_DOUBLE_EQ(row.here, 2.0);
  EXPECT_DOUBLE_EQ(*ratio_of(row), 0.5);
}

TEST(DriveRows, sum_up_series_by_episode) {
  EXPECT_THAT(largest_by_episode(example(), &EpisodeDigest::next_step),
              ElementsAre(0.3, 0.5, 0.2, 0.4));
  EXPECT_THAT(mean_by_episode(example(), &EpisodeDigest::next_step),
              ElementsAre(DoubleEq(0.2), DoubleEq(0.35), DoubleEq(0.2), DoubleEq(0.2)));
}

TEST(DriveRows, time_of_a_plan_is_that_of_a_drive_over_its_periods) {
  EXPECT_THAT(seconds_a_plan(example()), ElementsAre(1.0, 3.0, 9.0, 2.0));
}

TEST(LessOnAverage, holds_for_a_smaller_mean_only) {
  EXPECT_TRUE(less_on_average("", {1.0, 2.0}, {2.0, 2.0}).holds);
  EXPECT_FALSE(less_on_average("", {2.0, 2.0}, {1.0, 2.0}).holds);
  EXPECT_FALSE(less_on_average("", {2.0, 2.0}, {2.0, 2.0}).holds);
  EXPECT_FALSE(less_on_average("", {std::nan(""), 2.0}, {2.0, 2.0}).holds);
}

TEST(LessOnAverage, leaves_out_seeds_without_a_number) {
  const double none = std::nan("");
  const Claim claim = less_on_average("", {1.0, none, 3.0}, {4.0, 1.0, 4.0});
  EXPECT_TRUE(claim.holds);
  EXPECT_THAT(claim.evidence, HasSubstr("2 against 4; difference -2 ± 1 over 2 seeds"));
}

TEST(FallsWithinNoise, leaves_out_seeds_without_a_number) {
  const double none = std::nan("");
  const Claim claim = falls_within_noise("", {{5.0, 6.0, 1.0}, {3.0, 2.0, none}});
  EXPECT_TRUE(claim.holds);
  EXPECT_THAT(claim.evidence, HasSubstr("means over 2 seeds: 5.5"));
}

TEST(DriveRows, medians_leave_out_drives_that_end_before_their_first_period) {
  Sample sample = example();
  sample.episodes.push_back(drive(0.0, false, true, {}));
  ExperimentResult result;
  add_drive_rows({.name = "a", .variant = {}}, sample, result);
  EXPECT_DOUBLE_EQ(row_called(result, "certified").here, 0.35);
  EXPECT_DOUBLE_EQ(median_plan_seconds(sample), 2.5);
}

TEST(LessOnAverage, shows_the_numbers) {
  EXPECT_THAT(less_on_average("", {1.0, 3.0}, {4.0, 4.0}).evidence,
              HasSubstr("2 against 4; difference -2 ± 1 over 2 seeds"));
}

TEST(FallsWithinNoise, forgives_a_rise_that_chance_explains) {
  EXPECT_TRUE(falls_within_noise("", {{5.0, 6.0}, {3.0, 2.0}, {1.0, 1.5}}).holds);
  // A mean rise of 0.5 with a standard error of 1.5.
  EXPECT_TRUE(falls_within_noise("", {{1.0, 1.0}, {3.0, 0.0}}).holds);
  // The same increase in every episode.
  EXPECT_FALSE(falls_within_noise("", {{1.0, 1.0}, {1.5, 1.5001}}).holds);
}

TEST(SampleStatistics, are_those_of_the_sample) {
  EXPECT_DOUBLE_EQ(mean_of(std::vector<double>{1.0, 2.0, 6.0}), 3.0);
  EXPECT_DOUBLE_EQ(median_of({6.0, 1.0, 2.0}), 2.0);
  EXPECT_DOUBLE_EQ(median_of({6.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_DOUBLE_EQ(largest_of({1.0, 6.0, 2.0}), 6.0);
  // The three numbers have standard deviation √7.
  EXPECT_DOUBLE_EQ(standard_error_of({1.0, 2.0, 6.0}), std::sqrt(7.0 / 3.0));
}

TEST(SampleStatistics, of_nothing_are_not_a_number) {
  EXPECT_TRUE(std::isnan(mean_of(std::vector<double>{})));
  EXPECT_TRUE(std::isnan(median_of({})));
  EXPECT_TRUE(std::isnan(largest_of({})));
  EXPECT_TRUE(std::isnan(standard_error_of({1.0})));
}

}  // namespace drive_rows_test
}  // namespace qsmpc::harness
