#include "controller/certification/smoothed_bound.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

#include "controller/measure/normal/normal_distribution.hpp"
#include "controller/regions/soft_part.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace smoothed_bound_test {

using namespace testing;
constexpr int kSamples = 200000;
// Five standard errors of a mean of kSamples numbers in [0, 1] are at most 0.0056.
constexpr double kFiveStandardErrors = 0.0056;

/// E(1 − dist(y, [lower, upper])²/t²)₊ by quadrature between the kinks of the integrand.
double quadrature(double mean, double deviation, double lower, double upper, double t) {
  const auto integrand = [&](double y) {
    const double distance = std::max({lower - y, y - upper, 0.0});
    return std::max(0.0, 1.0 - distance * distance / (t * t)) *
           normal_density((y - mean) / deviation) / deviation;
  };
  const double low = mean - 12.0 * deviation;  // less than 1e-30 is beyond
  const double high = mean + 12.0 * deviation;
  std::vector<double> kinks = {low, high};
  for (const double kink : {lower - t, lower, upper, upper + t}) {
    if (kink > low && kink < high) kinks.push_back(kink);
  }
  std::sort(kinks.begin(), kinks.end());
  double sum = 0.0;
  for (std::size_t i = 1; i < kinks.size(); ++i) {
    sum += boost::math::quadrature::gauss_kronrod<double, 61>::integrate(integrand, kinks[i - 1],
                                                                         kinks[i], 10, 1e-12);
  }
  return sum;
}

TEST(SoftInterval, equals_numerical_quadrature) {
  Generator generator(61);
  for (int repetition = 0; repetition < 300; ++repetition) {
    const double mean = uniform(generator, -1.0, 1.0);
    const double deviation = std::pow(10.0, uniform(generator, -2.0, 0.5));
    double lower = uniform(generator, -2.0, 2.0);
    double upper = lower + uniform(generator, 0.0, 2.0);
    if (repetition % 3 == 0) lower = -kInfinity;
    if (repetition % 3 == 1) upper = kInfinity;
    const double t = std::pow(10.0, uniform(generator, -1.5, 1.0));
    const double value = soft_interval_probability(mean, deviation, lower, upper, t);
    const double expected = quadrature(mean, deviation, lower, upper, t);
    // 1e-9: the quadrature's own error and the allowance for rounding, which grows with 1/t².
    EXPECT_NEAR(value, expected, 1e-9);
    EXPECT_GE(value, expected - 1e-13);  // never below, except for the quadrature's rounding
  }
}

TEST(SoftInterval, without_spread_is_the_integrand) {
  EXPECT_EQ(soft_interval_probability(0.5, 0.0, 0.0, 1.0, 0.1), 1.0);
  EXPECT_DOUBLE_EQ(soft_interval_probability(2.0, 0.0, 0.0, 1.0, 2.0), 0.75);
  EXPECT_DOUBLE_EQ(soft_interval_probability(-1.0, 0.0, 0.0, kInfinity, 2.0), 0.75);
  EXPECT_EQ(soft_interval_probability(4.0, 0.0, 0.0, 1.0, 2.0), 0.0);
}

TEST(SoftInterval, is_at_least_the_probability_and_falls_towards_it_with_t) {
  const double probability = normal_probability(1.0, 2.0);
  double before = 1.0;
  for (double t = 4.0; t > 1e-3; t *= 0.5) {
    const double value = soft_interval_probability(0.0, 1.0, 1.0, 2.0, t);
    EXPECT_GE(value, probability);
    EXPECT_LE(value, before);
    before = value;
  }
  EXPECT_NEAR(before, probability, 2e-3 * (normal_density(1.0) + normal_density(2.0)));
}

/// E(1 − d(y, U)²/t²)₊ by simulation.
double simulated(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                 const SafeSet& safe_set, double t, Generator& generator) {
  NormalSampler sampler(covariance);
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double distance = distance_to_unsafe(mean + sampler(generator), safe_set);
    sum += std::max(0.0, 1.0 - distance * distance / (t * t));
  }
  return sum / kSamples;
}

SafeSet random_room(Generator& generator, int obstacles) {
  SafeSet room = unbounded_safe_set(3);
  room.bounds.lower.head<2>().setConstant(-1.5);
  room.bounds.upper[0] = 1.5;
  for (int i = 0; i < obstacles; ++i) {
    Box box{.lower = random_matrix(generator, 3, 1), .upper = {}};
    box.upper = box.lower + Eigen::VectorXd(random_matrix(generator, 3, 1).cwiseAbs());
    box.upper.array() += 0.1;
    if (i % 2 == 0) {
      box.lower[2] = -kInfinity;
      box.upper[2] = kInfinity;
    }
    room.obstacles.push_back(box);
  }
  return room;
}

TEST(SoftUnsafe, is_at_least_the_simulated_expectation) {
  Generator generator(62);
  for (int repetition = 0; repetition < 16; ++repetition) {
    const SafeSet room = random_room(generator, repetition % 4);
    Eigen::MatrixXd covariance = random_spd(generator, 3, 0.1);
    if (repetition % 2 == 0) covariance = covariance.diagonal().asDiagonal();
    const Eigen::VectorXd mean = random_matrix(generator, 3, 1);
    const double t = uniform(generator, 0.05, 1.0);
    EXPECT_GE(soft_unsafe_probability(mean, covariance, room, t),
              simulated(mean, covariance, room, t, generator) - kFiveStandardErrors);
  }
}

TEST(SoftUnsafe, correlated_obstacle_uses_the_most_unlikely_half_space) {
  // Heading unrestricted and correlated; the obstacle lies across the thin direction of the
  // position's ellipse, where single axes would give a poor bound.
  Eigen::Matrix3d covariance;
  covariance << 1.0, 0.95, 0.3,  //
      0.95, 1.0, 0.3,            //
      0.3, 0.3, 1.0;
  SafeSet room = unbounded_safe_set(3);
  room.obstacles.push_back(Box{.lower = Eigen::Vector3d(1.5, -2.0, -kInfinity),
                               .upper = Eigen::Vector3d(2.0, -1.5, kInfinity)});
  const double t = 0.01;
  const double value = soft_unsafe_probability(Eigen::Vector3d::Zero(), covariance, room, t);
  // The half-space x − y ≥ 3 is 3/√0.1 ≈ 9.5 deviations away; a single axis is 1.5.
  EXPECT_LE(value, 1e-12);
}

TEST(Smoothed, without_error_tends_to_the_probability) {
  SafeSet wall = unbounded_safe_set(1);
  wall.bounds.upper[0] = 2.0;
  const DiscreteMeasure centre{.locations = Points::Zero(1, 1),
                               .weights = Eigen::VectorXd::Ones(1)};
  const double probability = normal_cumulative(-2.0);
  const double value = smoothed_probability(
      {centre.locations, centre.weights, Eigen::MatrixXd::Ones(1, 1)}, wall, 0.0);
  EXPECT_GE(value, probability);
  // The probability within the least t, 1e-4, before the wall.
  EXPECT_LE(value, probability + 1e-4 * normal_density(1.9999));
}

TEST(Smoothed, is_at_least_the_probability_under_an_adversarial_error) {
  // The worst case: the error that moves the states nearest to the wall onto it until E|e|² is
  // spent.
  const double wall_at = 2.0;
  SafeSet wall = unbounded_safe_set(1);
  wall.bounds.upper[0] = wall_at;
  const DiscreteMeasure centre{.locations = Points::Zero(1, 1),
                               .weights = Eigen::VectorXd::Ones(1)};
  for (const double radius : {0.001, 0.01, 0.1, 0.3}) {
    // Moves all of (c, wall) to the wall; c solves ∫_c^wall (wall − y)² φ dy = radius².
    double low = -10.0;
    double high = wall_at;
    for (int bisection = 0; bisection < 60; ++bisection) {
      const double c = 0.5 * (low + high);
      const double cost = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
          [&](double y) { return (wall_at - y) * (wall_at - y) * normal_density(y); }, c, wall_at);
      (cost > radius * radius ? low : high) = c;
    }
    const double worst = normal_cumulative(-high);
    const double value = smoothed_probability(
        {centre.locations, centre.weights, Eigen::MatrixXd::Ones(1, 1)}, wall, radius);
    EXPECT_GE(value, worst - 1e-12) << radius;  // rounding of the bisection
    // The bound is the dual of this problem and is attained at its best t, which the search finds
    // to within a few percent; the value is flat around it.
    EXPECT_LE(value, 1.05 * worst) << radius;
  }
}

TEST(Smoothed, search_that_ends_early_ends_with_a_bound_of_no_use) {
  Generator generator(63);
  for (int repetition = 0; repetition < 40; ++repetition) {
    const SafeSet room = random_room(generator, repetition % 3);
    const DiscreteMeasure centres = random_measure(generator, 3, 8);
    const Eigen::MatrixXd covariance = random_spd(generator, 3, 0.05);
    const double radius = std::pow(10.0, uniform(generator, -4.0, -0.5));
    const double full =
        smoothed_probability({centres.locations, centres.weights, covariance}, room, radius);
    for (const double useful : {-0.1, 0.0, 1e-6, 0.5 * full, 1.2 * full, 1.0}) {
      const double value = smoothed_probability({centres.locations, centres.weights, covariance},
                                                room, radius, useful);
      // Two searches in t: each ends within a few percent of the optimum.
      EXPECT_GE(value, 0.97 * full);
      if (useful <= full) {
        EXPECT_GE(value, useful);
      } else {
        EXPECT_LE(value, 1.03 * full);
      }
    }
  }
}

TEST(Smoothed, says_one_where_nothing_is_known) {
  SafeSet wall = unbounded_safe_set(1);
  wall.bounds.upper[0] = 2.0;
  DiscreteMeasure centre{.locations = Points::Zero(1, 1), .weights = Eigen::VectorXd::Ones(1)};
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  EXPECT_EQ(smoothed_probability({centre.locations, centre.weights, one}, wall, kInfinity), 1.0);
  EXPECT_EQ(smoothed_probability({centre.locations, centre.weights, one}, wall, std::nan("")), 1.0);
  EXPECT_EQ(smoothed_probability({centre.locations, centre.weights, one}, wall, 1e3), 1.0);
  centre.locations(0, 0) = std::nan("");
  EXPECT_EQ(smoothed_probability({centre.locations, centre.weights, one}, wall, 0.1), 1.0);
}

}  // namespace smoothed_bound_test
}  // namespace qsmpc::controller
