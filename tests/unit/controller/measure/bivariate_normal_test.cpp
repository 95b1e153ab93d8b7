#include "controller/measure/normal/bivariate_normal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace bivariate_normal_test {

using namespace testing;

Eigen::Matrix2d covariance_of(double first, double second, double correlation) {
  const double cross = correlation * first * second;
  Eigen::Matrix2d covariance;
  covariance << first * first, cross, cross, second * second;
  return covariance;
}

/// The same probability by quadrature over the first coordinate of the conditional probability of
/// the second; split where that one changes fastest.
double quadrature(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                  const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  const double deviation = std::sqrt(covariance(0, 0));
  const double slope = covariance(0, 1) / covariance(0, 0);
  const double rest = std::sqrt(covariance(1, 1) - slope * covariance(0, 1));
  const auto integrand = [&](double z) {
    const double centre = mean[1] + slope * deviation * z;
    return normal_density(z) *
           normal_probability((lower[1] - centre) / rest, (upper[1] - centre) / rest);
  };
  const double low = std::max(-12.0, (lower[0] - mean[0]) / deviation);
  const double high = std::min(12.0, (upper[0] - mean[0]) / deviation);
  if (low >= high) return 0.0;
  std::vector<double> ends = {low, high};
  for (const double edge : {lower[1], upper[1]}) {
    const double centre = (edge - mean[1]) / (slope * deviation);
    const double width = rest / std::abs(slope * deviation);
    for (const double turn : {-12.0, -3.0, 0.0, 3.0, 12.0}) {
      const double split = centre + turn * width;
      if (split > low && split < high) ends.push_back(split);
    }
  }
  for (double split = std::ceil(low); split < high; ++split) ends.push_back(split);
  std::sort(ends.begin(), ends.end());
  double sum = 0.0;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, ends[i - 1],
                                                                         ends[i], 4, 1e-14);
  }
  return sum;
}

TEST(BivariateNormal, rectangles_equal_numerical_quadrature) {
  Generator generator(81);
  for (int repetition = 0; repetition < 400; ++repetition) {
    const double near_one = std::pow(10.0, uniform(generator, -4.0, -0.01));
    const double correlation = (repetition % 2 == 0 ? 1.0 : -1.0) * (1.0 - near_one);
    const Eigen::Matrix2d covariance =
        covariance_of(uniform(generator, 0.1, 2.0), uniform(generator, 0.1, 2.0), correlation);
    const Eigen::Vector2d mean = random_matrix(generator, 2, 1);
    Eigen::Vector2d lower = random_matrix(generator, 2, 1, 3.0);
    Eigen::Vector2d upper =
        lower + Eigen::Vector2d(uniform(generator, 0.0, 3.0), uniform(generator, 0.0, 3.0));
    if (repetition % 3 == 0) lower[repetition % 2] = -kInfinity;
    if (repetition % 5 == 0) upper[repetition % 2] = kInfinity;
    const double value = rectangle_probability(mean, covariance, lower, upper);
    EXPECT_NEAR(value, quadrature(mean, covariance, lower, upper), 1e-13)
        << repetition << " " << correlation;
  }
}

TEST(BivariateNormal, quadrants_have_their_known_values) {
  const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
  const Eigen::Vector2d below = Eigen::Vector2d::Constant(-kInfinity);
  const Eigen::Vector2d above = Eigen::Vector2d::Constant(kInfinity);
  for (const double correlation : {-0.999, -0.5, 0.0, 0.3, 0.99}) {
    const Eigen::Matrix2d covariance = covariance_of(2.0, 0.5, correlation);
    // Sheppard: ¼ + asin r/(2π).
    const double expected = 0.25 + std::asin(correlation) / (2.0 * std::numbers::pi);
    EXPECT_NEAR(rectangle_probability(zero, covariance, below, zero), expected, kRectangleError);
    EXPECT_NEAR(rectangle_probability(zero, covariance, zero, above), expected, kRectangleError);
    EXPECT_NEAR(rectangle_probability(zero, covariance, below, above), 1.0, kRectangleError);
    // A half-plane through the mean, and one to the side of it.
    EXPECT_NEAR(rectangle_probability(zero, covariance, below, Eigen::Vector2d(0.0, kInfinity)),
                0.5, kRectangleError);
    EXPECT_NEAR(rectangle_probability(zero, covariance, below, Eigen::Vector2d(kInfinity, -0.6)),
                normal_cumulative(-1.2), kRectangleError);
  }
}

TEST(BivariateNormal, edges_through_the_mean_halve_independent_coordinates) {
  const Eigen::Vector2d below = Eigen::Vector2d::Constant(-kInfinity);
  for (const double edge : {-2.0, -0.3, 0.4, 1.7}) {
    const double expected = 0.5 * normal_cumulative(edge);
    for (const Eigen::Vector2d& upper : {Eigen::Vector2d(0.0, edge), Eigen::Vector2d(edge, 0.0)}) {
      EXPECT_NEAR(
          rectangle_probability(Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity(), below, upper),
          expected, kRectangleError);
    }
  }
}

TEST(BivariateNormal, independent_coordinates_multiply) {
  Generator generator(82);
  for (int repetition = 0; repetition < 100; ++repetition) {
    const Eigen::Vector2d mean = random_matrix(generator, 2, 1);
    const Eigen::Vector2d lower = random_matrix(generator, 2, 1, 2.0);
    const Eigen::Vector2d upper = lower + Eigen::Vector2d(0.7, 1.9);
    const double value = rectangle_probability(mean, covariance_of(0.5, 1.5, 0.0), lower, upper);
    const double expected =
        normal_probability((lower[0] - mean[0]) / 0.5, (upper[0] - mean[0]) / 0.5) *
        normal_probability((lower[1] - mean[1]) / 1.5, (upper[1] - mean[1]) / 1.5);
    EXPECT_NEAR(value, expected, kRectangleError);
  }
}

TEST(BivariateNormal, dependent_coordinates_are_intervals_of_one) {
  const Eigen::Vector2d mean(1.0, -1.0);
  const Eigen::Vector2d lower(0.5, -1.5);
  const Eigen::Vector2d upper(2.0, 1.0);
  // y = −1 + (x − 1)/2 is in [−1.5, 1] for x in [0, 5]; with the other sign for x in [−3, 2].
  EXPECT_NEAR(rectangle_probability(mean, covariance_of(1.0, 0.5, 1.0), lower, upper),
              normal_probability(-0.5, 1.0), kRectangleError);
  EXPECT_NEAR(rectangle_probability(mean, covariance_of(1.0, 0.5, -1.0), lower, upper),
              normal_probability(-0.5, 1.0), kRectangleError);
  EXPECT_EQ(rectangle_probability(mean, covariance_of(1.0, 0.5, 1.0), Eigen::Vector2d(6.0, -1.5),
                                  Eigen::Vector2d(7.0, 1.0)),
            0.0);
}

TEST(BivariateNormal, known_coordinates_are_inside_or_nothing_is) {
  const Eigen::Vector2d mean(1.0, 2.0);
  const Eigen::Vector2d lower(0.0, 1.5);
  const Eigen::Vector2d upper(3.0, 2.5);
  const double beside = normal_probability(-1.0, 1.0);
  EXPECT_DOUBLE_EQ(rectangle_probability(mean, covariance_of(0.0, 0.5, 0.0), lower, upper), beside);
  EXPECT_EQ(
      rectangle_probability(Eigen::Vector2d(-1.0, 2.0), covariance_of(0.0, 0.5, 0.0), lower, upper),
      0.0);
  EXPECT_EQ(rectangle_probability(mean, Eigen::Matrix2d::Zero(), lower, upper), 1.0);
  EXPECT_EQ(rectangle_probability(Eigen::Vector2d(1.0, 3.0), Eigen::Matrix2d::Zero(), lower, upper),
            0.0);
}

TEST(BivariateNormal, tails_stay_probabilities) {
  Generator generator(83);
  for (int repetition = 0; repetition < 2000; ++repetition) {
    const double correlation = std::sin(uniform(generator, -1.6, 1.6));
    const Eigen::Matrix2d covariance = covariance_of(1.0, 1.0, correlation);
    const Eigen::Vector2d lower = random_matrix(generator, 2, 1, 12.0);
    const Eigen::Vector2d upper =
        lower + Eigen::Vector2d(random_matrix(generator, 2, 1, 12.0)).cwiseAbs();
    const double value = rectangle_probability(Eigen::Vector2d::Zero(), covariance, lower, upper);
    EXPECT_GE(value, 0.0);
    // Not above the probability of either coordinate.
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_LE(value, normal_probability(lower[axis], upper[axis]) + kRectangleError);
    }
  }
}

TEST(BivariateNormal, error_bound_holds_up_to_dependent_coordinates) {
  const Eigen::Vector2d lower(-kInfinity, 0.0);
  const Eigen::Vector2d upper(0.0, kInfinity);
  for (double gap = 0.1; gap > 1e-17; gap *= 0.3) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Matrix2d covariance = covariance_of(1.0, 1.0, sign * (1.0 - gap));
      // P(x ≤ 0 ≤ y) = acos(r)/(2π), with the correlation as it was rounded.
      const double rounded = 1.0 - std::abs(covariance(0, 1));
      const double angle = 2.0 * std::asin(std::sqrt(0.5 * rounded));
      const double expected =
          sign > 0.0 ? angle / (2.0 * std::numbers::pi) : 0.5 - angle / (2.0 * std::numbers::pi);
      const double error = rectangle_error(covariance);
      EXPECT_NEAR(rectangle_probability(Eigen::Vector2d::Zero(), covariance, lower, upper),
                  expected, error)
          << gap;
      EXPECT_LE(error, kRectangleError + 1e-15 / std::sqrt(gap) + (gap < 1e-15 ? 4e-8 : 0.0));
    }
    if (gap < 1e-12) continue;  // beyond, the reference loses its conditional variance
    const Eigen::Matrix2d covariance = covariance_of(0.7, 1.3, 1.0 - gap);
    const Eigen::Vector2d mean(0.3, 0.5);
    EXPECT_NEAR(rectangle_probability(mean, covariance, lower, upper),
                quadrature(mean, covariance, lower, upper), rectangle_error(covariance) + 1e-14)
        << gap;
  }
}

}  // namespace bivariate_normal_test
}  // namespace qsmpc::controller
