// The random numbers: statistics, independence of streams, and dependence on the key alone.
#include "models/random/random_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace qsmpc::models {
namespace random_numbers_test {

constexpr int kCount = 20000;
// Two-sided limit of a standard normal number that 1 of 10 000 exceeds; seeds are fixed, so a
// failure means that the generator has changed.
constexpr double kLimit = 3.89;

RandomKey key_at(std::uint64_t step, RandomStream stream = RandomStream::kDisturbance) {
  return {.seed = 11, .episode = 5, .stream = stream, .step = step};
}

TEST(GaussianSampler, has_the_mean_and_covariance_asked_for) {
  const Eigen::Vector3d mean(1.0, -2.0, 0.5);
  Eigen::Matrix3d covariance;
  covariance << 0.04, 0.01, -0.02, 0.01, 0.09, 0.0, -0.02, 0.0, 0.25;
  const GaussianSampler sampler(mean, covariance);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int k = 0; k < kCount; ++k) {
    const Eigen::Vector3d deviation = sampler.sample(key_at(k)) - mean;
    sum += deviation;
    squares += deviation * deviation.transpose();
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(sum[i]), kLimit * std::sqrt(kCount * covariance(i, i)));
    for (int j = 0; j < 3; ++j) {
      const double deviation = std::sqrt(
          (covariance(i, i) * covariance(j, j) + covariance(i, j) * covariance(i, j)) / kCount);
      EXPECT_NEAR(squares(i, j) / kCount, covariance(i, j), kLimit * deviation);
    }
  }
}

TEST(GaussianSampler, takes_a_covariance_without_full_rank) {
  const Eigen::Vector2d direction(1.0, 2.0);
  const GaussianSampler line(Eigen::Vector2d::Zero(), direction * direction.transpose());
  for (int k = 0; k < 100; ++k) {
    const Eigen::VectorXd value = line.sample(key_at(k));
    // The eigenvalue should be zero; its root is that of a rounding error.
    EXPECT_NEAR(value[1], 2.0 * value[0], 1e-6);
    EXPECT_GT(std::abs(value[0]), 0.0);
  }
  const GaussianSampler none(direction, Eigen::MatrixXd::Zero(2, 2));
  EXPECT_EQ(none.sample(key_at(0)), Eigen::VectorXd(direction));
}

TEST(GaussianSampler, refuses_invalid_covariances) {
  const Eigen::VectorXd mean = Eigen::VectorXd::Zero(2);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  EXPECT_NO_THROW(GaussianSampler(mean, covariance));
  EXPECT_THROW(GaussianSampler(mean, Eigen::MatrixXd::Identity(3, 3)), std::invalid_argument);
  covariance(0, 1) = 0.5;
  EXPECT_THROW(GaussianSampler(mean, covariance), std::invalid_argument);
  covariance(1, 0) = 0.5;
  EXPECT_NO_THROW(GaussianSampler(mean, covariance));
  covariance(0, 0) = 0.1;
  EXPECT_THROW(GaussianSampler(mean, covariance), std::invalid_argument);
  covariance(0, 0) = NAN;
  EXPECT_THROW(GaussianSampler(mean, covariance), std::invalid_argument);
}

TEST(RandomNumbers, depend_on_the_key_alone) {
  std::vector<Eigen::VectorXd> forwards;
  forwards.reserve(10);
  for (int k = 0; k < 10; ++k) forwards.push_back(standard_normal_sample(7, key_at(k)));
  for (int k = 9; k >= 0; --k) EXPECT_EQ(standard_normal_sample(7, key_at(k)), forwards[k]);
  // A longer sample starts with the shorter one.
  EXPECT_EQ(standard_normal_sample(3, key_at(4)), Eigen::VectorXd(forwards[4].head(3)));
}

TEST(RandomNumbers, change_with_every_part_of_the_key) {
  const RandomKey key = key_at(3);
  RandomKey other = key;
  const Eigen::VectorXd value = standard_normal_sample(4, key);
  other.seed ^= 1;
  EXPECT_NE(value, standard_normal_sample(4, other));
  other = key;
  other.episode ^= 1;
  EXPECT_NE(value, standard_normal_sample(4, other));
  other = key;
  other.stream = RandomStream::kInitialState;
  EXPECT_NE(value, standard_normal_sample(4, other));
  other = key;
  other.step ^= 1;
  EXPECT_NE(value, standard_normal_sample(4, other));
}

double correlation_with(const RandomKey& offset) {
  double sum = 0.0;
  for (int k = 0; k < kCount; ++k) {
    RandomKey shifted = offset;
    shifted.step += static_cast<std::uint64_t>(k);
    sum += standard_normal_sample(1, key_at(k))[0] * standard_normal_sample(1, shifted)[0];
  }
  return sum / kCount;
}

TEST(RandomNumbers, random_words_are_all_different_and_depend_on_the_key_alone) {
  std::vector<std::uint64_t> words(1001);  // not a multiple of the generator's block
  std::vector<std::uint64_t> first(10);
  random_words(key_at(3, RandomStream::kBootstrap), words);
  random_words(key_at(3, RandomStream::kBootstrap), first);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), words.begin()));
  random_words(key_at(4, RandomStream::kBootstrap), first);
  words.insert(words.end(), first.begin(), first.end());
  std::sort(words.begin(), words.end());
  EXPECT_EQ(std::adjacent_find(words.begin(), words.end()), words.end());
}

TEST(RandomNumbers, of_neighbouring_keys_are_uncorrelated) {
  // The correlation of independent numbers has standard deviation 1/sqrt(n).
  const double limit = kLimit / std::sqrt(kCount);
  EXPECT_LT(std::abs(correlation_with(key_at(0, RandomStream::kInitialState))), limit);
  EXPECT_LT(std::abs(correlation_with(key_at(0, RandomStream::kSensor))), limit);
  EXPECT_LT(std::abs(correlation_with(key_at(0, RandomStream::kParameters))), limit);
  EXPECT_LT(std::abs(correlation_with(key_at(1))), limit);
  EXPECT_LT(std::abs(correlation_with({.seed = 12, .episode = 5})), limit);
  EXPECT_LT(std::abs(correlation_with({.seed = 11, .episode = 6})), limit);
}

TEST(RandomNumbers, are_distributed_as_they_say) {
  std::vector<double> normal;
  std::vector<double> uniform;
  for (int k = 0; k < kCount; ++k) {
    normal.push_back(standard_normal_sample(1, key_at(k))[0]);
    uniform.push_back(uniform_sample(1, key_at(k, RandomStream::kInput))[0]);
  }
  std::ranges::sort(normal);
  std::ranges::sort(uniform);
  double normal_distance = 0.0;
  double uniform_distance = 0.0;
  for (int k = 0; k < kCount; ++k) {
    const double empirical = (k + 0.5) / kCount;
    const double cdf = 0.5 * std::erfc(-normal[k] / std::sqrt(2.0));
    normal_distance = std::max(normal_distance, std::abs(cdf - empirical));
    uniform_distance = std::max(uniform_distance, std::abs(uniform[k] - empirical));
  }
  EXPECT_GT(uniform.front(), 0.0);
  EXPECT_LE(uniform.back(), 1.0);
  // Kolmogorov-Smirnov limit: exceeded by 1 of 10 000 samples.
  const double limit = 2.23 / std::sqrt(kCount);
  EXPECT_LT(normal_distance, limit);
  EXPECT_LT(uniform_distance, limit);
}

}  // namespace random_numbers_test
}  // namespace qsmpc::models
