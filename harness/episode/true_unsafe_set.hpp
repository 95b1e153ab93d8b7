// What is unsafe in a drive, with the obstacles that move where they truly are.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_part.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/episode/moving_obstacles.hpp"

namespace qsmpc::harness {

/// A forecast of its own for what moves in the safe set; null where nothing does.
[[nodiscard]] std::shared_ptr<controller::ObstacleForecast> new_forecast(
    const controller::SafeSet& safe_set);

class TrueUnsafeSet {
 public:
  explicit TrueUnsafeSet(controller::SafeSet safe_set);

  /// Puts the obstacles where they are: offset x, y (m) and turn (rad), 3 x count.
  void place(const Eigen::Matrix3Xd& poses);

  /// The part that a state is in, and its distance from all of them.
  [[nodiscard]] controller::UnsafePart part(const Eigen::VectorXd& state) const {
    return controller::unsafe_part(state, unsafe_);
  }
  [[nodiscard]] double clearance(const Eigen::Ref<const Eigen::VectorXd>& state) const {
    return controller::clearance(state, unsafe_);
  }

  /// Of the states at the simulator's steps of the period that `others` have gone through last; not
  /// a number without any. The obstacles are at its end thereafter.
  [[nodiscard]] double least_clearance(const Eigen::MatrixXd& states,
                                       const MovingObstacles& others);

 private:
  std::shared_ptr<controller::ObstacleForecast> places_;
  controller::UnsafeSet unsafe_;
};

}  // namespace qsmpc::harness
