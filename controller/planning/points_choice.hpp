// How many points a planner needs: as few as keep what its plans cost within a tolerance.
//
//   PlannerSettings settings = …;               // with the most that it may have
//   choose_points(*car, belief, {.tolerance = 1e-3}, settings).apply_to(settings);
//
// Fewer points take less time: predictions, and every evaluation of a solver, take time in
// proportion to their number.
#pragma once

#include "controller/measure/measures.hpp"
#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// What is asked for.
struct PointsSearch {
  /// What plans may cost more for having fewer points, relative, > 0.
  double tolerance = 1e-3;
  /// Of the way to the target, a horizon each, that are looked at at most, >= 1.
  int stretches = 8;
};

/// What was found.
struct PointsChoice {
  int state_points = 0;       ///< of the belief
  int compressed_points = 0;  ///< kept after each step of the prediction
  /// What plans cost more with them, relative, at the place where it is the most: not above the
  /// tolerance; below 0 where these points are misleading nowhere; 0 of all points.
  double gap = 0.0;
  int places = 0;  ///< that were compared; without any, all points are kept

  /// Puts the numbers into `settings`.
  void apply_to(PlannerSettings& settings) const {
    settings.state_points = state_points;
    settings.compressed_points = compressed_points;
  }
};

/// Plans with numbers of points from 2 state_dim + 1 upwards, and returns the lowest that misleads
/// no plan by more than the tolerance; those of `settings` are the most. Plans are compared from
/// `belief` (state_dim) and from places on the way to the target, each at the nominal end of the
/// plan before, with the covariance of one period's noise, until a plan stays where it is; and from
/// the point at the end of each of these plans that is nearest to the unsafe set, where the noise
/// may well take the state. Each is a first plan.
///
/// With J_n what the planner with n points predicts, N the most, and π_n and π_N the plans of the
/// two, J_N(π_n) − J_N(π_N) = [J_n(π_n) − J_n(π_N)] + [(J_N − J_n)(π_n) − (J_N − J_n)(π_N)]. The
/// first bracket is the solver's: not above 0 where it finds the best plan, and else as much a
/// matter of luck with many points as with few. The second is what the points mislead by, and what
/// is held against the tolerance. Where the risk is limited, a plan that keeps the limits by n
/// points has to keep them by N.
///
/// Depends on nothing but its arguments; deadlines do not count. Throws std::invalid_argument as
/// Planner, and on a search that makes no sense.
[[nodiscard]] PointsChoice choose_points(const models::Dynamics& dynamics, const Gaussian& belief,
                                         const PointsSearch& search,
                                         const PlannerSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
