// Places that are to be passed in order, the last of which is where the drive ends.
//
//   int passed = waypoints_passed(route, system, state, passed);   // in every period
//   route.next(passed);                                            // the target until then
#pragma once

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

struct Waypoints {
  Eigen::MatrixXd states;  ///< state_dim x n, n ≥ 1: what is wanted at each, in order
  double radius = 0.5;     ///< m, in the plane: within it all but the last count as passed

  [[nodiscard]] int count() const { return static_cast<int>(states.cols()); }
  /// What is driven to once `passed` of them have been passed, state_dim; at the end the last.
  [[nodiscard]] auto next(double passed) const {
    const auto known = static_cast<Eigen::Index>(passed);
    return states.col(known < states.cols() ? known : states.cols() - 1);
  }
};

/// How many have been passed by a vehicle that is in `state` (state_dim), of which `before` were
/// earlier on: those that follow in turn and are within the radius. The last is never passed, as
/// the drive ends there.
[[nodiscard]] int waypoints_passed(const Waypoints& route, const models::SystemDescription& system,
                                   const Eigen::Ref<const Eigen::VectorXd>& state, int before);

/// The way from `state` to the next waypoint, and straight on over the others to the last, m.
[[nodiscard]] double way_over(const Waypoints& route, const models::SystemDescription& system,
                              const Eigen::Ref<const Eigen::VectorXd>& state, double passed);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
