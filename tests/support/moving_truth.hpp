// Where obstacles that move are, simulated by means of its own: what forecasts are held against.
#pragma once

#include <random>
#include <vector>

#include <Eigen/Core>

#include "models/motion/obstacle_motion.hpp"

namespace qsmpc::testing {

/// Many runs of one motion, side by side.
class MovingTruth {
 public:
  /// They begin as the motion says; time_step: of a period, s.
  MovingTruth(models::ObstacleMotion motion, double time_step, int runs,
              std::mt19937_64& generator);

  /// One period on, all of them.
  void advance(std::mt19937_64& generator);

  /// How far run `i` is from where it is written, m, and turned, rad.
  [[nodiscard]] Eigen::Vector2d offset(int i) const;
  [[nodiscard]] double turn(int i) const;
  /// Which way it goes.
  [[nodiscard]] std::size_t way(int i) const { return runs_[static_cast<std::size_t>(i)].way; }

 private:
  struct Run {
    std::size_t way = 0;
    double off[2] = {0.0, 0.0};   // along and across
    double rate[2] = {0.0, 0.0};  // of these
  };

  models::ObstacleMotion motion_;
  double time_step_;
  double time_ = 0.0;
  std::vector<Run> runs_;
  std::normal_distribution<double> normal_;
};

}  // namespace qsmpc::testing
