#include "controller/certification/worst_case.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/certification/published_certificate.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace worst_case_test {

using namespace testing;
constexpr double kRounding = 1e-13;  // sums of a few numbers of at most one

/// min over λ ≥ 0 of λ r² + Σ π (1 − λ d²)₊, the dual: piecewise linear and convex in λ, so the
/// minimum is at a kink λ = 1/d² or at 0.
double dual(const Eigen::VectorXd& distances, const Eigen::VectorXd& weights, double radius) {
  const auto value = [&](double lambda) {
    return lambda * radius * radius +
           (weights.array() * (1.0 - lambda * distances.array().square()).max(0.0)).sum();
  };
  double least = value(0.0);
  for (const double distance : distances) {
    if (distance > 0.0) least = std::min(least, value(1.0 / (distance * distance)));
  }
  return std::min(1.0, least);
}

TEST(WorstCase, equals_the_dual_problem) {
  Generator generator(51);
  for (int repetition = 0; repetition < 500; ++repetition) {
    const int size = 1 + repetition % 9;
    const DiscreteMeasure measure = random_measure(generator, 2, size);
    Eigen::VectorXd distances = random_matrix(generator, size, 1, 2.0).cwiseAbs();
    if (repetition % 5 == 0) distances[0] = 0.0;
    const double radius = uniform(generator, 0.001, 2.5);
    EXPECT_NEAR(worst_case_probability(distances, measure.weights, radius),
                dual(distances, measure.weights, radius), kRounding);
  }
}

TEST(WorstCase, two_points_by_hand) {
  const Eigen::Vector2d distances(1.0, 2.0);
  const Eigen::Vector2d weights(0.25, 0.75);
  // 0.25 · 1² is spent on the first point; the remaining 0.75 moves 0.75/2² of the second.
  EXPECT_NEAR(worst_case_probability(distances, weights, 1.0), 0.25 + 0.1875, kRounding);
  EXPECT_NEAR(worst_case_probability(distances, weights, 0.1), 0.01, kRounding);
  EXPECT_NEAR(worst_case_probability(distances, weights, 0.5), 0.25, kRounding);
  EXPECT_EQ(worst_case_probability(distances, weights, 5.0), 1.0);
}

TEST(WorstCase, radius_zero_counts_only_what_is_unsafe_already) {
  const Eigen::Vector3d distances(0.3, 0.0, 1e-9);
  const Eigen::Vector3d weights(0.5, 0.2, 0.3);
  EXPECT_DOUBLE_EQ(worst_case_probability(distances, weights, 0.0), 0.2);
}

TEST(WorstCase, infinite_radius_gives_one_and_infinite_distance_is_out_of_reach) {
  const Eigen::Vector2d distances(0.5, kInfinity);
  const Eigen::Vector2d weights(0.4, 0.6);
  EXPECT_EQ(worst_case_probability(distances, weights, kInfinity), 1.0);
  EXPECT_DOUBLE_EQ(worst_case_probability(distances, weights, 1e6), 0.4);
  // A radius whose square overflows counts as infinite.
  EXPECT_EQ(worst_case_probability(Eigen::Vector2d(1e200, 1.0), weights, 1e180), 1.0);
}

TEST(WorstCase, grows_with_the_radius) {
  Generator generator(52);
  const DiscreteMeasure measure = random_measure(generator, 2, 20);
  const Eigen::VectorXd distances = random_matrix(generator, 20, 1).cwiseAbs();
  double before = 0.0;
  for (double radius = 0.0; radius < 1.5; radius += 0.01) {
    const double value = worst_case_probability(distances, measure.weights, radius);
    EXPECT_GE(value, before);
    before = value;
  }
  EXPECT_EQ(before, 1.0);
}

TEST(WorstCase, of_a_measure_uses_the_distance_to_walls_and_obstacles) {
  SafeSet safe_set{
      .bounds = {.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(9.0, 9.0)},
      .obstacles = {Box{.lower = Eigen::Vector2d(5.0, 0.0), .upper = Eigen::Vector2d(6.0, 9.0)}}};
  DiscreteMeasure measure{.locations = Points(2, 2), .weights = Eigen::Vector2d(0.5, 0.5)};
  measure.locations << 4.0, 1.0,  //
      4.0, 4.5;
  // Distances 1 (obstacle) and 1 (left wall).
  EXPECT_NEAR(worst_case_probability(measure, safe_set, 0.5), 0.25, kRounding);
}

TEST(WorstCase, refuses_invalid_arguments) {
  const Eigen::Vector2d distances(1.0, 2.0);
  const Eigen::Vector2d weights(0.5, 0.5);
  const double nan = std::nan("");
  EXPECT_THROW((void)worst_case_probability(distances, Eigen::Vector3d(0.2, 0.3, 0.5), 1.0),
               std::invalid_argument);
  EXPECT_THROW((void)worst_case_probability(distances, Eigen::Vector2d(-0.5, 1.5), 1.0),
               std::invalid_argument);
  EXPECT_THROW((void)worst_case_probability(distances, Eigen::Vector2d(nan, 0.5), 1.0),
               std::invalid_argument);
  EXPECT_THROW((void)worst_case_probability(Eigen::Vector2d(-1.0, 2.0), weights, 1.0),
               std::invalid_argument);
  EXPECT_THROW((void)worst_case_probability(Eigen::Vector2d(nan, 2.0), weights, 1.0),
               std::invalid_argument);
  EXPECT_THROW((void)worst_case_probability(distances, weights, -1.0), std::invalid_argument);
  EXPECT_THROW((void)worst_case_probability(distances, weights, nan), std::invalid_argument);
}

TEST(LinearTransportProbability, spends_distances_in_the_order_of_their_size) {
  const SafeSet room{
      .bounds = {.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(8.0, 10.0)},
      .obstacles = {}};
  // Distances 0.5, 2 and 4 to the nearest wall.
  DiscreteMeasure measure{.locations = Points(2, 3), .weights = Eigen::Vector3d(0.2, 0.3, 0.5)};
  measure.locations << 0.5, 2.0, 4.0,  //
      5.0, 5.0, 5.0;
  // All of the first point costs 0.1, a third of the second 0.2.
  EXPECT_NEAR(linear_transport_probability(measure, room, 0.3), 0.3, kRounding);
  EXPECT_EQ(linear_transport_probability(measure, room, 0.0), 0.0);
  EXPECT_EQ(linear_transport_probability(measure, room, 100.0), 1.0);
}

TEST(LinearTransportProbability, is_never_below_the_exact_worst_case) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.0, 8.0);
  const SafeSet room{
      .bounds = {.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(8.0, 8.0)},
      .obstacles = {Box{.lower = Eigen::Vector2d(3.0, 4.0), .upper = Eigen::Vector2d(3.5, 4.5)}}};
  for (int repeat = 0; repeat < 200; ++repeat) {
    constexpr Eigen::Index kCount = 12;
    DiscreteMeasure measure{.locations = Points(2, kCount),
                            .weights = Eigen::VectorXd::Constant(kCount, 1.0 / kCount)};
    for (double& value : measure.locations.reshaped()) value = place(random);
    const double radius = place(random) / 4.0;
    EXPECT_GE(linear_transport_probability(measure, room, radius) + kRounding,
              worst_case_probability(measure, room, radius));
  }
}

TEST(ThesisProbability, takes_the_norm_of_the_face_distances_and_ignores_obstacles) {
  const SafeSet room{
      .bounds = {.lower = Eigen::Vector2d(-2.0, 1.0), .upper = Eigen::Vector2d(6.0, 11.0)},
      .obstacles = {Box{.lower = Eigen::Vector2d(1.0, 5.0), .upper = Eigen::Vector2d(1.5, 5.5)}}};
  const DiscreteMeasure point{.locations = Eigen::Vector2d(1.0, 5.0),
                              .weights = Eigen::VectorXd::Ones(1)};
  // The published formula: distance 5, spent linearly, gives 1/5; the point is in fact on an
  // obstacle.
  EXPECT_NEAR(thesis_probability(point, room.bounds, 1.0), 0.2, kRounding);
  EXPECT_EQ(worst_case_probability(point, room, 0.0), 1.0);
}

}  // namespace worst_case_test
}  // namespace qsmpc::controller
