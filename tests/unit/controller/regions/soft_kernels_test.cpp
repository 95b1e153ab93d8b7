#include "controller/regions/soft_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/smoothed_bound.hpp"
#include "controller/measure/normal/bivariate_normal.hpp"
#include "controller/regions/soft_part.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace smoothed_kernels_test {

using namespace testing;
// The scalar formula's own allowance for the far tails, and its rounding for numbers up to one.
constexpr double kScalarError = 1e-15;

/// How much the vector loops may add to the truth at an end of an interval within reach.
double slack_of_end(double wall, double deviation, double t) {
  if (std::isinf(wall) || wall - t > 8.6 * deviation || wall < -8.6 * deviation) return 0.0;
  return 2.0 * kSoftMomentError * (wall * wall + deviation * deviation) / (t * t);
}

/// Expects `value` to be a bound of E(1 − dist²/t²)₊ with the documented accuracy.
void expect_close_bound(double value, double mean, const SoftInterval& interval, double t) {
  const double scalar =
      soft_interval_probability(mean, interval.deviation, interval.lower, interval.upper, t);
  const double below = interval.lower - mean;
  const double above = mean - interval.upper;
  const double slack = slack_of_end(below, interval.deviation, t) +
                       slack_of_end(above, interval.deviation, t) + 2.0 * kSoftMassError;
  // The scalar formula adds 8 roundings of (D² + s²)/t², less than a tenth of this slack.
  EXPECT_GE(value, scalar - 0.1 * slack - kScalarError);
  EXPECT_LE(value, scalar + slack + kScalarError);
  EXPECT_LE(value, 1.0);
}

/// Intervals of every kind: two ends, one, none; wide and empty; near and far.
SoftInterval random_interval(Generator& generator, int kind) {
  const double lower = uniform(generator, -3.0, 3.0) * (kind % 7 == 0 ? 100.0 : 1.0);
  const double width = kind % 5 == 0 ? 0.0 : std::pow(10.0, uniform(generator, -3.0, 1.0));
  return {.lower = kind % 3 == 1 ? -kInfinity : lower,
          .upper = kind % 3 == 2 || kind % 11 == 1 ? kInfinity : lower + width,
          .deviation = kind % 13 == 0 ? 0.0 : std::pow(10.0, uniform(generator, -3.0, 1.0))};
}

TEST(SoftKernels, bound_the_scalar_formula_for_every_reach) {
  Generator generator(171);
  for (int kind = 0; kind < 500; ++kind) {
    const SoftInterval interval = random_interval(generator, kind);
    // Including counts of reaches that no vector width divides.
    const std::size_t count = 1 + kind % 19;
    std::vector<double> reaches(count);
    for (double& reach : reaches) reach = std::pow(10.0, uniform(generator, -3.0, 6.0));
    std::vector<double> values(count + 1, -1.0);
    soft_interval_by_reach(interval, reaches.data(), count, values.data());
    for (std::size_t i = 0; i < count; ++i) {
      expect_close_bound(values[i], 0.0, interval, reaches[i]);
    }
    EXPECT_EQ(values[count], -1.0);
  }
}

TEST(SoftKernels, bound_the_scalar_formula_for_every_mean) {
  Generator generator(172);
  for (int kind = 0; kind < 500; ++kind) {
    const SoftInterval interval = random_interval(generator, kind);
    const double t = std::pow(10.0, uniform(generator, -3.0, 2.0));
    const std::size_t count = 1 + kind % 19;
    std::vector<double> means(count);
    for (double& mean : means) mean = uniform(generator, -4.0, 4.0);
    std::vector<double> values(count + 1, -1.0);
    soft_interval_by_mean(interval, t, means.data(), count, values.data());
    for (std::size_t i = 0; i < count; ++i) expect_close_bound(values[i], means[i], interval, t);
    EXPECT_EQ(values[count], -1.0);
  }
}

TEST(SoftKernels, of_far_and_of_all_covering_intervals_are_zero_and_one) {
  const double reach = 1.0;
  double value = 0.0;
  const auto at = [&](double lower, double upper, double deviation) {
    soft_interval_by_reach({.lower = lower, .upper = upper, .deviation = deviation}, &reach, 1,
                           &value);
    return value;
  };
  EXPECT_LE(at(1e6, kInfinity, 1.0), kSoftMassError);
  EXPECT_LE(at(-kInfinity, -1e6, 1.0), kSoftMassError);
  EXPECT_EQ(at(-kInfinity, kInfinity, 1.0), 1.0);
  EXPECT_EQ(at(-1e6, 1e6, 1e-3), 1.0);
  EXPECT_EQ(at(2.0, 3.0, 0.0), 0.0);
  EXPECT_EQ(at(0.5, 3.0, 0.0), 0.75);
}

TEST(RectangleEstimate, is_near_the_probability) {
  Generator generator(173);
  for (int repetition = 0; repetition < 500; ++repetition) {
    StandardRectangle rectangle{};
    Eigen::Vector2d lower;
    Eigen::Vector2d upper;
    for (int axis = 0; axis < 2; ++axis) {
      lower[axis] = repetition % 4 == axis ? -kInfinity : uniform(generator, -4.0, 4.0);
      upper[axis] = repetition % 5 == axis
                        ? kInfinity
                        : std::max(lower[axis], -4.0) + uniform(generator, 0.0, 6.0);
      rectangle.low[axis] = lower[axis];
      rectangle.high[axis] = upper[axis];
    }
    const double r = uniform(generator, -0.8, 0.8);
    Eigen::Matrix2d covariance;
    covariance << 1.0, r, r, 1.0;
    const double exact = rectangle_probability(Eigen::Vector2d::Zero(), covariance, lower, upper);
    // Error of Gauss quadrature with 16 nodes over at most 12 deviations.
    EXPECT_NEAR(rectangle_estimate(rectangle, r), exact, 3e-2 * exact + 1e-6);
  }
}

}  // namespace smoothed_kernels_test
}  // namespace qsmpc::controller
