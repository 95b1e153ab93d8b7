#include "harness/episode/moving_obstacles.hpp"

#include <array>
#include <utility>

#include <Eigen/Geometry>

#include "models/motion/obstacle_poses.hpp"

namespace qsmpc::harness {
namespace {

using models::RandomKey;
using models::RandomStream;

/// The key of one of several obstacles.
RandomKey of_obstacle(RandomKey key, std::size_t index) {
  key.episode = index;
  return key;
}

/// The way drawn: the one whose share of the probabilities contains a uniform random number.
std::size_t drawn_way(const std::vector<models::IntendedWay>& ways, const RandomKey& key) {
  double left = models::uniform_sample(1, key)[0];
  for (std::size_t i = 0; i + 1 < ways.size(); ++i) {
    left -= ways[i].probability;
    if (left <= 0.0) return i;
  }
  return ways.size() - 1;
}

}  // namespace

MovingObstacles::MovingObstacles(const controller::SafeSet& safe_set, double time_step, int stages,
                                 std::shared_ptr<controller::ObstacleForecast> forecast)
    : time_step_(time_step), stages_(stages), forecast_(std::move(forecast)) {
  for (const controller::Obstacle* obstacle : controller::moving_obstacles(safe_set)) {
    bodies_.push_back({.motion = *obstacle->motion,
                       .centre = controller::shape_centre(*obstacle->shape()),
                       .filter = controller::MotionFilter(*obstacle->motion, time_step)});
    forecast_->set(bodies_.size() - 1, bodies_.back().filter.forecast(stages));
  }
  poses_ = last_poses_ = Eigen::Matrix3Xd::Zero(3, count());
  seen_ = Eigen::Matrix2Xd::Zero(2, count());
}

void MovingObstacles::begin(const KeyOf& key) {
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    Body& body = bodies_[n];
    body.filter.begin();
    body.way = drawn_way(body.motion.ways, of_obstacle(key(RandomStream::kObstacleWay), n));
    body.clock = 0.0;
    std::array<double, 4> drawn{};
    models::standard_normals(of_obstacle(key(RandomStream::kObstacleStart), n), drawn);
    const Eigen::Matrix2d normal = Eigen::Map<const Eigen::Matrix2d>(drawn.data());
    body.deviation << normal.row(0).cwiseProduct(body.motion.start_deviation.transpose()),
        normal.row(1).cwiseProduct(body.motion.speed_deviation.transpose());
    poses_.col(static_cast<Eigen::Index>(n)) = pose_of(body);
  }
  last_poses_ = poses_;
}

void MovingObstacles::advance(const Eigen::Vector2d& vehicle, const KeyOf& key) {
  last_poses_ = poses_;
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    Body& body = bodies_[n];
    body.filter.advance();
    const Eigen::Vector2d place = body.centre + poses_.col(static_cast<Eigen::Index>(n)).head<2>();
    const bool waits = (vehicle - place).norm() < body.motion.yields;
    if (waits) continue;
    body.clock += time_step_;
    std::array<double, 4> drawn{};
    models::standard_normals(of_obstacle(key(RandomStream::kObstacleMotion), n), drawn);
    for (int i = 0; i < 2; ++i) {
      const models::DeviationStep by = models::deviation_step(body.motion, i, time_step_);
      const std::size_t first = 2 * static_cast<std::size_t>(i);
      double& deviation = body.deviation(0, i);
      double& rate = body.deviation(1, i);
      rate = by.memory * rate + by.rate_noise * drawn[first];
      deviation = by.kept * deviation + by.period * rate + by.walk_noise * drawn[first + 1];
    }
    poses_.col(static_cast<Eigen::Index>(n)) = pose_of(body);
  }
}

Eigen::Vector3d MovingObstacles::pose_of(const Body& body) {
  const models::IntendedWay& way = body.motion.ways[body.way];
  const double direction = models::way_direction(way, body.clock);
  const Eigen::Vector2d deviation = body.deviation.row(0).transpose();
  Eigen::Vector3d pose;
  pose << models::intended_offset(way, body.clock) + Eigen::Rotation2Dd(direction) * deviation,
      body.motion.turns ? direction - models::way_direction(way, 0.0) : 0.0;
  return pose;
}

void MovingObstacles::see(const KeyOf& key) {
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    Body& body = bodies_[n];
    std::array<double, 2> drawn{};
    models::standard_normals(of_obstacle(key(RandomStream::kObstacleSensor), n), drawn);
    const auto column = static_cast<Eigen::Index>(n);
    seen_.col(column) = poses_.col(column).head<2>() +
                        body.motion.seen_deviation * Eigen::Vector2d(drawn[0], drawn[1]);
    body.filter.see(seen_.col(column));
    forecast_->set(n, body.filter.forecast(stages_));
  }
}

Eigen::Matrix3Xd MovingObstacles::poses_at(double share) const {
  return models::poses_between(last_poses_, poses_, share);
}

}  // namespace qsmpc::harness
