// How many points a planner needs: as few as keep the cost of its plans within a tolerance.
//
//   PlannerSettings settings = …;               // with the most that it may have
//   choose_points(*car, belief, {.tolerance = 1e-3}, settings).apply_to(settings);
//
// Fewer points take less time: the time of predictions and of each solver evaluation is
// proportional to their number.
#pragma once

#include "controller/measure/measures.hpp"
#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// The request.
struct PointsSearch {
  /// Relative increase in cost that is tolerated for fewer points, > 0.
  double tolerance = 1e-3;
  /// Largest number of stretches of the way to the target, one horizon each, to examine, >= 1.
  int stretches = 8;
};

/// The result.
struct PointsChoice {
  int state_points = 0;       ///< of the belief
  int compressed_points = 0;  ///< kept after each step of the prediction
  /// Relative increase in cost with these points, over all places: at most the tolerance; negative
  /// if the cost falls; 0 if all points are kept.
  double gap = 0.0;
  int places = 0;  ///< number compared; with none, all points are kept

  /// Puts the numbers into `settings`.
  void apply_to(PlannerSettings& settings) const {
    settings.state_points = state_points;
    settings.compressed_points = compressed_points;
  }
};

/// Plans with the points of `settings`, lets planners with increasing numbers of points, from
/// 2 state_dim + 1 on, go on from these plans, and returns the lowest numbers that make them dearer
/// by no more than the tolerance. Plans are compared from `belief` (state_dim); from places on the
/// way to the target, each at the nominal end of the plan before, with the covariance of one
/// period's noise, until a plan stays in place; and, for each of these plans, from its final point
/// nearest to the unsafe set, where the noise may well take the state.
///
/// Let J_N be the cost predicted with the most points, π_N a plan with these, and π_n what the
/// planner with n points makes of it (Planner::plan_from). J_N(π_n) − J_N(π_N), summed over all
/// places, relative to the sum of J_N(π_N), is compared with the tolerance. As π_n starts from π_N,
/// the comparison is about the points, and hardly about luck in finding a minimum. With risk
/// limits, a plan that keeps them with n points must also keep them with N.
///
/// Depends only on its arguments; deadlines are ignored. Throws std::invalid_argument as Planner
/// does, and on an invalid search.
[[nodiscard]] PointsChoice choose_points(const models::Dynamics& dynamics, const Gaussian& belief,
                                         const PointsSearch& search,
                                         const PlannerSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
