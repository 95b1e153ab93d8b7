#include "controller/measure/normal_quantiser.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/measure/normal_distribution.hpp"

namespace qsmpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct KnownDistortion {
  int count;
  double w2_squared;
};

// Computed by an independent implementation in higher precision.
constexpr KnownDistortion kKnown[] = {
    {1, 1.0},
    {2, 0.363380227632419},
    {3, 0.190174039247901},
    {4, 0.117481847829329},
    {5, 0.0799411270882774},
    {7, 0.0440003824986234},
    {10, 0.0229370529045015},
    {16, 0.00950100800819189},
    {20, 0.00620778988488803},
    {30, 0.002839280404280611},
    {49, 0.0010893279714725445},
    {64, 0.0006442396653170089},
    {100, 0.0002667122194611027},
    {200, 6.733112412593578e-05},
    {500, 1.0837920556094509e-05},
    {1000, 2.7150262418950572e-06},
};

TEST(NormalQuantiser, distortion_matches_the_reference) {
  // The reference is given to 1e-8 relative.
  for (const auto& [count, w2_squared] : kKnown) {
    EXPECT_NEAR(normal_quantiser(count).distortion, w2_squared, 1e-8 * w2_squared) << count;
  }
}

TEST(NormalQuantiser, weights_sum_to_one_and_points_are_symmetric_and_increasing) {
  for (const int count : {1, 2, 3, 8, 33, 200, 1000}) {
    const NormalQuantiser& quantiser = normal_quantiser(count);
    ASSERT_EQ(quantiser.points.size(), count);
    EXPECT_NEAR(quantiser.weights.sum(), 1.0, 1e-14);  // rounding of a sum of `count` numbers
    EXPECT_EQ(quantiser.points, -quantiser.points.reverse());
    for (int i = 1; i < count; ++i) EXPECT_LT(quantiser.points[i - 1], quantiser.points[i]);
  }
}

TEST(NormalQuantiser, points_are_the_centroids_of_their_cells) {
  for (const int count : {2, 3, 8, 33, 200, 1000}) {
    const NormalQuantiser& quantiser = normal_quantiser(count);
    for (int i = 0; i < count; ++i) {
      const double low =
          i == 0 ? -kInfinity : 0.5 * (quantiser.points[i - 1] + quantiser.points[i]);
      const double high =
          i + 1 == count ? kInfinity : 0.5 * (quantiser.points[i] + quantiser.points[i + 1]);
      const double mass = normal_probability(low, high);
      const double moment = normal_density(low) - normal_density(high);
      EXPECT_DOUBLE_EQ(quantiser.weights[i], mass);
      // Moments are differences of numbers up to 0.4: rounding of 1e-16, whatever the cell's mass.
      EXPECT_NEAR(quantiser.points[i] * mass, moment, 1e-15);
    }
  }
}

TEST(NormalQuantiser, lost_variance_is_the_distortion) {
  for (const int count : {1, 2, 5, 50, 400}) {
    const NormalQuantiser& quantiser = normal_quantiser(count);
    const double kept = (quantiser.weights.array() * quantiser.points.array().square()).sum();
    EXPECT_NEAR(kept + quantiser.distortion, 1.0, 1e-13);  // rounding of sums near one
  }
}

TEST(NormalQuantiser, approximate_distortion_is_exact_up_to_its_limit_and_close_beyond) {
  EXPECT_DOUBLE_EQ(approximate_distortion(kExactDistortions),
                   normal_quantiser(kExactDistortions).distortion);
  // Next term of the asymptotic expansion: a relative 1/n.
  EXPECT_NEAR(approximate_distortion(1000), 2.7150262418950572e-06, 0.02 * 2.7150262418950572e-06);
}

TEST(NormalQuantiser, no_points_are_refused) {
  EXPECT_THROW((void)normal_quantiser(0), std::invalid_argument);
  EXPECT_THROW((void)normal_quantiser(-3), std::invalid_argument);
}

TEST(NormalDistribution, tails_keep_their_relative_accuracy) {
  // Φ(−10) and Φ(−11) from tables; both lie far below the spacing of doubles near one.
  EXPECT_NEAR(normal_cumulative(-10.0) / 7.619853024160527e-24, 1.0, 1e-12);
  EXPECT_NEAR(normal_probability(10.0, kInfinity) / 7.619853024160527e-24, 1.0, 1e-12);
  EXPECT_NEAR(normal_probability(-kInfinity, kInfinity), 1.0, 0.0);
  EXPECT_EQ(normal_density_moment(kInfinity), 0.0);
}

}  // namespace
}  // namespace qsmpc
