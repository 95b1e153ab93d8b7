// Positions of moving obstacles by an independent simulation: the reference for forecasts.
#pragma once

#include <random>
#include <vector>

#include <Eigen/Core>

#include "models/motion/obstacle_motion.hpp"

namespace qsmpc::testing {

/// Many runs of one motion in parallel.
class MovingTruth {
 public:
  /// Runs start as `motion` specifies; time_step: one period, s.
  MovingTruth(models::ObstacleMotion motion, double time_step, int runs,
              std::mt19937_64& generator);

  /// Advances all runs by one period.
  void advance(std::mt19937_64& generator);

  /// Deviation of run `i` from its written position, m, and heading, rad.
  [[nodiscard]] Eigen::Vector2d offset(int i) const;
  [[nodiscard]] double turn(int i) const;
  /// Index of the way that run `i` takes.
  [[nodiscard]] std::size_t way(int i) const { return runs_[static_cast<std::size_t>(i)].way; }

 private:
  struct Run {
    std::size_t way = 0;
    double off[2] = {0.0, 0.0};   // along and across
    double rate[2] = {0.0, 0.0};  // rate of change of `off`, same axes
  };

  models::ObstacleMotion motion_;
  double time_step_;
  double time_ = 0.0;
  std::vector<Run> runs_;
  std::normal_distribution<double> normal_;
};

}  // namespace qsmpc::testing
