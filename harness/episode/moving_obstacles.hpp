// The moving obstacles of a drive: their true positions, their observations, and their forecast.
//
//   MovingObstacles obstacles(safe_set, 0.1, 20, forecast);
//   obstacles.begin(key), obstacles.see(key);
//   obstacles.advance(vehicle, key), ++period, obstacles.see(key);   // in every period
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "controller/surroundings/motion_filter.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {

class MovingObstacles {
 public:
  /// The key of a stream's random numbers in the present period.
  using KeyOf = std::function<models::RandomKey(models::RandomStream)>;

  /// Forecasts over `stages` stages beyond the present are written to `forecast`, which is null if
  /// nothing moves.
  MovingObstacles(const controller::SafeSet& safe_set, double time_step, int stages,
                  std::shared_ptr<controller::ObstacleForecast> forecast);

  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(bodies_.size()); }

  /// Draws ways and initial positions.
  void begin(const KeyOf& key);
  /// Advances by one period. `vehicle`: its position at the beginning of the period (m), for
  /// obstacles that yield.
  void advance(const Eigen::Vector2d& vehicle, const KeyOf& key);
  /// Observes the positions, once per period, and writes the forecast.
  void see(const KeyOf& key);

  /// The true poses: offset x, y (m) from the written position, and turn (rad); 3 x count.
  [[nodiscard]] const Eigen::Matrix3Xd& poses() const { return poses_; }
  /// The poses at the beginning of the last completed period.
  [[nodiscard]] const Eigen::Matrix3Xd& last_poses() const { return last_poses_; }
  /// The poses at a fraction 0 … 1 of the last completed period.
  [[nodiscard]] Eigen::Matrix3Xd poses_at(double share) const;
  /// The observed offsets, 2 x count.
  [[nodiscard]] const Eigen::Matrix2Xd& seen() const { return seen_; }

 private:
  /// The state of one obstacle.
  struct Body {
    models::ObstacleMotion motion;
    Eigen::Vector2d centre;
    controller::MotionFilter filter;
    std::size_t way = 0;
    double clock = 0.0;                                   ///< s since it set off
    Eigen::Matrix2d deviation = Eigen::Matrix2d::Zero();  ///< and its rate, along and across
  };

  [[nodiscard]] static Eigen::Vector3d pose_of(const Body& body);

  double time_step_;
  int stages_;
  std::shared_ptr<controller::ObstacleForecast> forecast_;
  std::vector<Body> bodies_;
  Eigen::Matrix3Xd poses_;
  Eigen::Matrix3Xd last_poses_;
  Eigen::Matrix2Xd seen_;
};

}  // namespace qsmpc::harness
