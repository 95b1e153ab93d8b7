// The unsafe set of a drive, with moving obstacles at their true positions.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_part.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/episode/moving_obstacles.hpp"

namespace qsmpc::harness {

/// A separate forecast for the moving obstacles of the safe set; null if nothing moves.
[[nodiscard]] std::shared_ptr<controller::ObstacleForecast> new_forecast(
    const controller::SafeSet& safe_set);

class TrueUnsafeSet {
 public:
  explicit TrueUnsafeSet(controller::SafeSet safe_set);

  /// Moves the obstacles: offset x, y (m) and turn (rad), 3 x count.
  void place(const Eigen::Matrix3Xd& poses);

  /// The part of the unsafe set that a state is in, and its clearance from all parts.
  [[nodiscard]] controller::UnsafePart part(const Eigen::VectorXd& state) const {
    return controller::unsafe_part(state, unsafe_);
  }
  [[nodiscard]] double clearance(const Eigen::Ref<const Eigen::VectorXd>& state) const {
    return controller::clearance(state, unsafe_);
  }

  /// The least clearance of the states at the simulator's steps in the last period of `others`; not
  /// a number without any. Afterwards the obstacles are at the end of the period.
  [[nodiscard]] double least_clearance(const Eigen::MatrixXd& states,
                                       const MovingObstacles& others);

 private:
  std::shared_ptr<controller::ObstacleForecast> places_;
  controller::UnsafeSet unsafe_;
};

}  // namespace qsmpc::harness
