#include "harness/mismatch/residual_statistics.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace residual_statistics_test {

Eigen::MatrixXd row(std::initializer_list<double> values) {
  Eigen::MatrixXd matrix(1, static_cast<Eigen::Index>(values.size()));
  Eigen::Index column = 0;
  for (const double value : values) matrix(0, column++) = value;
  return matrix;
}

const Eigen::VectorXd kOne = Eigen::VectorXd::Ones(1);

TEST(ResidualStatistics, mean_covariance_and_rmse_are_over_all_periods_of_all_episodes) {
  Eigen::MatrixXd first(2, 2);
  first << 1.0, 3.0, 0.0, 2.0;
  Eigen::MatrixXd second(2, 1);
  second << 5.0, 4.0;
  const ResidualStatistics statistics =
      residual_statistics({first, second}, Eigen::Vector2d(1.0, 1.0));
  EXPECT_EQ(statistics.periods, 3);
  EXPECT_TRUE(statistics.mean.isApprox(Eigen::Vector2d(3.0, 2.0), 1e-14));
  EXPECT_NEAR(statistics.rmse[0], std::sqrt(35.0 / 3.0), 1e-14);
  EXPECT_NEAR(statistics.rmse[1], std::sqrt(20.0 / 3.0), 1e-14);
  EXPECT_NEAR(statistics.covariance(0, 0), 8.0 / 3.0, 1e-14);
  EXPECT_NEAR(statistics.covariance(0, 1), 8.0 / 3.0, 1e-14);
}

// Deviations from the mean 1: sums per episode +2 and −2, two episodes, four periods:
// √((4 + 4)·2/1)/4.
TEST(ResidualStatistics, the_mean_is_as_uncertain_as_whole_episodes_make_it) {
  const ResidualStatistics statistics =
      residual_statistics({row({2.0, 2.0}), row({0.0, 0.0})}, kOne);
  EXPECT_NEAR(statistics.mean_deviation[0], 1.0, 1e-14);
  EXPECT_TRUE(std::isnan(residual_statistics({row({2.0, 1.0})}, kOne).mean_deviation[0]));
}

// Mean 0, c_0 = 4, c_1 = −1 + −1 + −1 over three pairs of one episode of four periods.
TEST(ResidualStatistics, of_one_episode_the_statistic_is_that_of_ljung_and_box) {
  const ResidualStatistics statistics = residual_statistics({row({1.0, -1.0, 1.0, -1.0})}, kOne);
  const Whiteness& whiteness = statistics.whiteness;
  EXPECT_EQ(whiteness.lags, 3);
  EXPECT_NEAR(whiteness.lag1[0], -0.75, 1e-14);
  EXPECT_NEAR(whiteness.lag1_deviation, std::sqrt(3.0 / 24.0), 1e-14);
  // n (n + 2) Σ ρ_h²/(n − h) with ρ = −3/4, 1/2, −1/4.
  EXPECT_NEAR(whiteness.ljung_box[0], 24.0 * (0.5625 / 3.0 + 0.25 / 2.0 + 0.0625 / 1.0), 1e-13);
  // χ² with three degrees of freedom above 9: erfc(√4.5) + √(18/π) e^(−4.5).
  EXPECT_NEAR(whiteness.p_value[0],
              std::erfc(std::sqrt(4.5)) + std::sqrt(18.0 / M_PI) * std::exp(-4.5), 1e-12);
}

TEST(ResidualStatistics, periods_of_different_episodes_are_not_neighbours) {
  // Joined, they would be 1, 1, −1, −1 with two more pairs.
  const Whiteness whiteness =
      residual_statistics({row({1.0, 1.0}), row({-1.0, -1.0})}, kOne).whiteness;
  EXPECT_EQ(whiteness.lags, 1);
  EXPECT_NEAR(whiteness.lag1[0], 2.0 / 4.0, 1e-14);
  EXPECT_NEAR(whiteness.lag1_deviation, std::sqrt(2.0 / 24.0), 1e-14);
}

std::vector<Eigen::MatrixXd> random_episodes(std::uint64_t seed, double memory) {
  std::vector<Eigen::MatrixXd> episodes;
  for (std::uint64_t n = 0; n < 20; ++n) {
    Eigen::MatrixXd episode =
        models::standard_normal_sample(40, {.seed = seed, .episode = n}).transpose();
    for (Eigen::Index k = 1; k < episode.cols(); ++k) {
      episode(0, k) += memory * episode(0, k - 1);
    }
    episodes.push_back(episode);
  }
  return episodes;
}

TEST(ResidualStatistics, white_noise_is_found_white_and_one_with_a_memory_is_not) {
  int rejected = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Whiteness white = residual_statistics(random_episodes(seed, 0.0), kOne).whiteness;
    rejected += white.p_value[0] < 0.05 ? 1 : 0;
  }
  // 10 of 200 are expected; 3 … 20 with a probability of all but 0.004.
  EXPECT_GE(rejected, 3);
  EXPECT_LE(rejected, 20);
  const Whiteness coloured = residual_statistics(random_episodes(1, 0.5), kOne).whiteness;
  EXPECT_LT(coloured.p_value[0], 1e-10);
  EXPECT_NEAR(coloured.lag1[0], 0.5, 5.0 * coloured.lag1_deviation);
}

TEST(ResidualStatistics, what_rounding_leaves_is_below_the_floor_and_a_nanometre_is_not) {
  const double magnitude = 12.0;  // m
  const double half_unit = 0.5 * std::numeric_limits<double>::epsilon() * magnitude;
  const Eigen::VectorXd size = Eigen::VectorXd::Constant(1, magnitude);
  const ResidualStatistics rounding =
      residual_statistics({row({half_unit, -half_unit, half_unit})}, size);
  EXPECT_LE(rounding.rmse[0], rounding.rounding[0]);
  EXPECT_GT(residual_statistics({row({1e-9, -1e-9})}, size).rmse[0], rounding.rounding[0]);
}

TEST(ResidualStatistics, of_nothing_and_of_what_never_changes_no_correlation_is_a_number) {
  const ResidualStatistics none = residual_statistics({}, kOne);
  EXPECT_EQ(none.periods, 0);
  EXPECT_EQ(none.rmse[0], 0.0);
  EXPECT_TRUE(std::isnan(none.whiteness.lag1[0]));
  const ResidualStatistics constant = residual_statistics({row({0.0, 0.0, 0.0})}, kOne);
  EXPECT_TRUE(std::isnan(constant.whiteness.lag1[0]));
  EXPECT_TRUE(std::isnan(constant.whiteness.p_value[0]));
}

}  // namespace residual_statistics_test
}  // namespace qsmpc::harness
