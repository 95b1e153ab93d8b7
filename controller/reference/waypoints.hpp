// Places to pass in order; the drive ends at the last one.
//
//   int passed = waypoints_passed(route, system, state, passed);   // in every period
//   route.next(passed);                                            // the target until then
#pragma once

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

struct Waypoints {
  Eigen::MatrixXd states;  ///< state_dim x n, n ≥ 1: the wanted state at each, in order
  double radius = 0.5;     ///< m, in the plane; within it, all but the last count as passed

  [[nodiscard]] int count() const { return static_cast<int>(states.cols()); }
  /// The target once `passed` waypoints have been passed, state_dim; in the end the last one.
  [[nodiscard]] auto next(double passed) const {
    const auto known = static_cast<Eigen::Index>(passed);
    return states.col(known < states.cols() ? known : states.cols() - 1);
  }
};

/// How many waypoints a vehicle in `state` (state_dim) has passed: `before` plus those that follow
/// in order and are within the radius. The last is never passed, as the drive ends there.
[[nodiscard]] int waypoints_passed(const Waypoints& route, const models::SystemDescription& system,
                                   const Eigen::Ref<const Eigen::VectorXd>& state, int before);

/// The length of the way from `state` straight to the next waypoint and on through the others to
/// the last, m.
[[nodiscard]] double way_over(const Waypoints& route, const models::SystemDescription& system,
                              const Eigen::Ref<const Eigen::VectorXd>& state, double passed);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
