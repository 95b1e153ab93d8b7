#include "controller/certification/initial_risk.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace initial_risk_test {

/// Between x = 0 and 10, with one obstacle above.
SafeSet corridor() {
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.bounds.lower[0] = 0.0;
  safe_set.bounds.upper[0] = 10.0;
  safe_set.obstacles.push_back(Box{.lower = Eigen::Vector3d(4.0, 2.0, -kInfinity),
                                   .upper = Eigen::Vector3d(6.0, 3.0, kInfinity)});
  return safe_set;
}

Body two_discs() {
  return {.discs = {{.radius = 0.3, .offset = {0.4, 0.0}}, {.radius = 0.3, .offset = {-0.2, 0.1}}},
          .x = 0,
          .y = 1,
          .heading = 2};
}

/// A root of the covariance of (x, y, heading), all of which are correlated.
Eigen::Matrix3d root() {
  Eigen::Matrix3d root;
  root << 0.3, 0.0, 0.0, 0.1, 0.25, 0.0, 0.05, -0.1, 0.3;
  return root;
}

Gaussian correlated(const Eigen::Vector3d& mean, double scale) {
  return {.mean = mean, .covariance = scale * scale * root() * root().transpose()};
}

/// The share of unsafe states among `count` draws of correlated(mean, 1).
double simulated(const Eigen::Vector3d& mean, const UnsafeSet& unsafe, int count) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  Points states(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double x = normal(generator);
    const double y = normal(generator);
    states.col(i) = mean + root() * Eigen::Vector3d(x, y, normal(generator));
  }
  return (clearances(states, unsafe).array() <= 0.0).cast<double>().mean();
}

TEST(InitialRisk, of_a_point_at_a_wall_is_its_normal_tail) {
  const Gaussian belief{.mean = Eigen::Vector3d(0.2, 0.0, 0.0),
                        .covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal()};
  // Two standard deviations: Φ(−2); the far wall and the obstacle contribute nothing.
  EXPECT_NEAR(initial_risk(belief, corridor()), 0.022750131948179, 1e-9);
}

TEST(InitialRisk, bounds_what_is_simulated_and_is_not_far_above_it) {
  constexpr int kDraws = 400000;
  constexpr double kMostAbove = 2.0;  // two discs, each counted separately
  for (const bool body : {false, true}) {
    SafeSet safe_set = corridor();
    if (body) safe_set.body = two_discs();
    const UnsafeSet unsafe(safe_set);
    for (const Eigen::Vector3d& mean :
         {Eigen::Vector3d(1.0, 0.0, 2.5), Eigen::Vector3d(3.3, 1.6, 0.4),
          Eigen::Vector3d(5.0, 1.1, 1.5)}) {
      const Gaussian belief = correlated(mean, 1.0);
      const double truth = simulated(mean, unsafe, kDraws);
      const double deviation = std::sqrt(truth * (1.0 - truth) / kDraws);
      const double bound = initial_risk(belief, unsafe);
      EXPECT_GE(bound, truth - 4.0 * deviation) << mean.transpose() << " body " << body;
      EXPECT_LE(bound, kMostAbove * truth + 0.05) << mean.transpose() << " body " << body;
    }
  }
}

TEST(InitialRisk, counts_the_body_and_not_the_position_alone) {
  SafeSet safe_set = corridor();
  const Gaussian belief = correlated({9.25, 0.0, 0.0}, 0.1);
  EXPECT_LT(initial_risk(belief, safe_set), 1e-6);
  safe_set.body = two_discs();  // they extend 0.7 ahead
  EXPECT_GT(initial_risk(belief, safe_set), 1e-3);
  EXPECT_LT(initial_risk(belief, safe_set), 0.1);
}

TEST(InitialRisk, of_a_known_state_is_zero_or_one) {
  SafeSet safe_set = corridor();
  safe_set.body = two_discs();
  Gaussian belief{.mean = Eigen::Vector3d(5.0, 0.0, 0.0), .covariance = Eigen::Matrix3d::Zero()};
  EXPECT_LE(initial_risk(belief, safe_set), 1e-9);  // allowance of sums for rounding
  belief.mean[1] = 1.8;
  EXPECT_EQ(initial_risk(belief, safe_set), 1.0);
}

}  // namespace initial_risk_test
}  // namespace qsmpc::controller
