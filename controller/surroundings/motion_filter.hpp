// The exact law of a moving obstacle's place given the measurements of it: a Kalman filter for each
// way that it may intend to go, and the probabilities of the ways (docs/theory/motion.md).
//
//   MotionFilter filter(motion, 0.1);
//   filter.begin();
//   filter.see(offset);                      // in period 0; then, period by period,
//   filter.advance(); filter.see(offset);
//   forecast->set(0, filter.forecast(20));
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "controller/surroundings/obstacle_forecast.hpp"
#include "models/motion/obstacle_motion.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

class MotionFilter {
 public:
  /// time_step: length of a period, s. Throws std::invalid_argument as check_obstacle_motion, and
  /// unless time_step > 0.
  MotionFilter(models::ObstacleMotion motion, double time_step);

  /// Resets to the beginning of a drive: the prior of the motion, without measurements.
  void begin();
  /// Updates with a measurement of the current offset. Throws std::invalid_argument where it is not
  /// finite.
  void see(const Eigen::Vector2d& offset);
  /// Advances by one period.
  void advance();

  /// The forecast for stages 0 (now) … `stages`.
  [[nodiscard]] PlacesByStage forecast(int stages) const;
  /// Probability of each way given the measurements; they sum to 1.
  [[nodiscard]] std::vector<double> probabilities() const;

 private:
  /// Law of the deviation and its rate in one direction.
  struct Deviation {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  };
  struct Way {
    double log_weight = 0.0;
    std::array<Deviation, 2> deviations{};  ///< along and across
  };

  [[nodiscard]] double time(int stage) const { return (period_ + stage) * time_step_; }
  void step(Way& way) const;
  [[nodiscard]] ObstaclePlace place(std::size_t index, const Way& way, double weight,
                                    int stage) const;

  models::ObstacleMotion motion_;
  double time_step_;
  std::array<models::DeviationStep, 2> steps_;
  std::vector<double> first_directions_;  // of each way
  int period_ = 0;
  std::vector<Way> ways_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
