// The estimate of an obstacle, compared with simulation, and with conditioning a joint Gaussian at
// once.
#include "controller/surroundings/motion_filter.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/support/effort.hpp"
#include "tests/support/moving_truth.hpp"

namespace qsmpc::controller {
namespace motion_filter_test {

using models::IntendedWay;
using models::ObstacleMotion;

constexpr double kTimeStep = 0.2;

/// A walker heading north-east that drifts and returns to its line.
ObstacleMotion walker() {
  return {.ways = {models::steady_way({0.6, 0.8})},
          .start_deviation = {0.2, 0.1},
          .speed_deviation = {0.3, 0.15},
          .memory = 0.9,
          .returns_in = {0.0, 2.0},
          .covariance_rate = {0.02, 0.01},
          .seen_deviation = 0.07};
}

ObstacleMotion undecided() {
  ObstacleMotion motion = walker();
  motion.ways = {
      models::steady_way({1.0, 0.0}),
      {.points = {{.time = 0.0}, {.time = 0.8, .place = {0.8, 0.0}}}, .onward = {0.0, 1.2}}};
  motion.ways[0].probability = 0.3;
  motion.ways[1].probability = 0.7;
  return motion;
}

TEST(MotionFilter, forecast_before_anything_is_seen_has_the_moments_of_simulated_motions) {
  const int runs = testing::by_effort(20000, 60000, 200000);
  for (const ObstacleMotion& motion : {walker(), undecided()}) {
    std::mt19937_64 generator(5);
    testing::MovingTruth truth(motion, kTimeStep, runs, generator);
    const PlacesByStage forecast = MotionFilter(motion, kTimeStep).forecast(10);
    for (int stage = 0; stage <= 10; ++stage) {
      if (stage > 0) truth.advance(generator);
      for (std::size_t way = 0; way < motion.ways.size(); ++way) {
        Eigen::Vector2d mean = Eigen::Vector2d::Zero();
        Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
        int count = 0;
        for (int i = 0; i < runs; ++i) {
          if (truth.way(i) != way) continue;
          mean += truth.offset(i);
          square += truth.offset(i) * truth.offset(i).transpose();
          ++count;
        }
        mean /= count;
        const ObstaclePlace& place = forecast[static_cast<std::size_t>(stage)][way];
        const double error = 5.0 / std::sqrt(count);
        EXPECT_NEAR(place.weight, static_cast<double>(count) / runs, error);
        EXPECT_LT((place.offset - mean).norm(), error * std::sqrt(place.covariance.trace()));
        EXPECT_LT((square / count - mean * mean.transpose() - place.covariance).norm(),
                  2.0 * error * place.covariance.trace());
      }
    }
  }
}

/// The deviation in one direction at the periods 0 … count as a linear map of independent standard
/// normal numbers; written out from the recursion of the motion.
Eigen::MatrixXd deviations_by_normals(const ObstacleMotion& motion, int direction, int count) {
  const double remembered = std::exp(-kTimeStep / motion.memory);
  const double returns = motion.returns_in[direction];
  const double kept = returns > 0.0 ? std::exp(-kTimeStep / returns) : 1.0;
  const double speed = motion.speed_deviation[direction];
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(count + 1, 2 + 2 * count);
  Eigen::RowVectorXd rate = Eigen::RowVectorXd::Zero(map.cols());
  map(0, 0) = motion.start_deviation[direction];
  rate[1] = speed;
  for (int k = 1; k <= count; ++k) {
    rate *= remembered;
    rate[2 * k] += speed * std::sqrt(1.0 - remembered * remembered);
    map.row(k) = kept * map.row(k - 1) + kTimeStep * rate;
    map(k, 2 * k + 1) += std::sqrt(kTimeStep * motion.covariance_rate[direction]);
  }
  return map;
}

/// Observations of the first periods: some offsets near the way.
std::vector<Eigen::Vector2d> seen_offsets(const IntendedWay& way, int count) {
  std::mt19937_64 generator(8);
  std::normal_distribution<double> normal(0.0, 0.15);
  std::vector<Eigen::Vector2d> seen;
  for (int k = 0; k < count; ++k) {
    seen.emplace_back(models::intended_offset(way, k * kTimeStep) +
                      Eigen::Vector2d(normal(generator), normal(generator)));
  }
  return seen;
}

/// The law of the deviation `stage` periods after the last observation, and the log-density of the
/// observations up to a constant.
struct Conditioned {
  double mean;
  double variance;
  double log_density;
};

Conditioned conditioned(const ObstacleMotion& motion, int direction, const Eigen::VectorXd& seen,
                        int stage) {
  const Eigen::Index count = seen.size();
  const Eigen::MatrixXd map =
      deviations_by_normals(motion, direction, static_cast<int>(count) - 1 + stage);
  const Eigen::MatrixXd covariance = map * map.transpose();
  Eigen::MatrixXd of_seen = covariance.topLeftCorner(count, count);
  of_seen.diagonal().array() += std::pow(motion.seen_deviation, 2);
  const Eigen::VectorXd with = covariance.row(covariance.rows() - 1).head(count).transpose();
  const Eigen::LLT<Eigen::MatrixXd> root(of_seen);
  const Eigen::MatrixXd lower = root.matrixL();
  return {.mean = with.dot(root.solve(seen)),
          .variance =
              covariance(covariance.rows() - 1, covariance.rows() - 1) - with.dot(root.solve(with)),
          .log_density = -0.5 * seen.dot(root.solve(seen)) - lower.diagonal().array().log().sum()};
}

TEST(MotionFilter, what_is_known_is_the_law_given_all_that_was_seen) {
  const ObstacleMotion motion = walker();
  const IntendedWay& way = motion.ways.front();
  const std::vector<Eigen::Vector2d> seen = seen_offsets(way, 6);
  MotionFilter filter(motion, kTimeStep);
  Eigen::Matrix2Xd off(2, 6);
  const Eigen::Matrix2d frame = (Eigen::Matrix2d() << 0.6, -0.8, 0.8, 0.6).finished();
  for (int k = 0; k < 6; ++k) {
    if (k > 0) filter.advance();
    filter.see(seen[static_cast<std::size_t>(k)]);
    off.col(k) = frame.transpose() *
                 (seen[static_cast<std::size_t>(k)] - models::intended_offset(way, k * kTimeStep));
  }
  const PlacesByStage forecast = filter.forecast(8);
  for (const int stage : {0, 1, 4, 8}) {
    const ObstaclePlace& place = forecast[static_cast<std::size_t>(stage)].front();
    const Eigen::Vector2d deviation =
        frame.transpose() * (place.offset - models::intended_offset(way, (5 + stage) * kTimeStep));
    const Eigen::Matrix2d covariance = frame.transpose() * place.covariance * frame;
    for (const int i : {0, 1}) {
      const Conditioned expected = conditioned(motion, i, off.row(i).transpose(), stage);
      EXPECT_NEAR(deviation[i], expected.mean, 1e-12) << stage;
      EXPECT_NEAR(covariance(i, i), expected.variance, 1e-13) << stage;
    }
    EXPECT_NEAR(covariance(0, 1), 0.0, 1e-15);
  }
}

TEST(MotionFilter, ways_become_as_probable_as_bayes_says) {
  const ObstacleMotion motion = undecided();
  const std::vector<Eigen::Vector2d> seen = seen_offsets(motion.ways[0], 6);
  MotionFilter filter(motion, kTimeStep);
  std::vector<double> logs;
  for (const IntendedWay& way : motion.ways) {
    Eigen::Matrix2Xd off(2, 6);
    for (int k = 0; k < 6; ++k) {
      const double heading = models::way_direction(way, k * kTimeStep);
      const Eigen::Vector2d from =
          seen[static_cast<std::size_t>(k)] - models::intended_offset(way, k * kTimeStep);
      off.col(k) << std::cos(heading) * from.x() + std::sin(heading) * from.y(),
          std::cos(heading) * from.y() - std::sin(heading) * from.x();
    }
    logs.push_back(std::log(way.probability) +
                   conditioned(motion, 0, off.row(0).transpose(), 0).log_density +
                   conditioned(motion, 1, off.row(1).transpose(), 0).log_density);
  }
  for (int k = 0; k < 6; ++k) {
    if (k > 0) filter.advance();
    filter.see(seen[static_cast<std::size_t>(k)]);
  }
  const double ratio = std::exp(logs[1] - logs[0]);
  const std::vector<double> probabilities = filter.probabilities();
  EXPECT_NEAR(probabilities[0], 1.0 / (1.0 + ratio), 1e-9);
  EXPECT_NEAR(probabilities[1], ratio / (1.0 + ratio), 1e-9);
  EXPECT_GT(probabilities[0], 0.5);  // the true way, though less probable at first
  filter.begin();
  EXPECT_DOUBLE_EQ(filter.probabilities()[0], 0.3);
}

TEST(MotionFilter, certain_motion_is_forecast_for_certain_whatever_is_seen) {
  ObstacleMotion motion{.ways = {models::steady_way({0.0, 2.0})}, .turns = true};
  motion.ways.front().points.push_back({.time = 1.0, .place = {1.0, 0.0}});
  MotionFilter filter(motion, kTimeStep);
  filter.see({0.3, 0.1});
  filter.advance();
  const PlacesByStage forecast = filter.forecast(20);
  const ObstaclePlace& place = forecast[9].front();  // at 2 s
  EXPECT_TRUE(place.offset.isApprox(Eigen::Vector2d(1.0, 2.0)));
  EXPECT_TRUE(place.covariance.isZero(0.0));
  EXPECT_NEAR(place.turn, 0.5 * std::numbers::pi, 1e-12);
}

TEST(MotionFilter, refuses_invalid_arguments) {
  EXPECT_THROW(MotionFilter(walker(), 0.0), std::invalid_argument);
  EXPECT_THROW(MotionFilter(ObstacleMotion{.ways = {}}, 0.1), std::invalid_argument);
  MotionFilter filter(walker(), kTimeStep);
  EXPECT_THROW(filter.see({NAN, 0.0}), std::invalid_argument);
}

}  // namespace motion_filter_test
}  // namespace qsmpc::controller
