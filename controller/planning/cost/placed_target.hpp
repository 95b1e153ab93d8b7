// The reference of a plan's cost: the target, the next part of a path, or the next waypoint.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/planning/cost/quadratic_cost.hpp"
#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// Sets the targets of `weights` for a plan from `state` (state_dim): settings.cost.target, nearest
/// modulo 2π; or the next of settings.waypoints after `progress` of them (if empty, the first); or
/// along settings.path from `progress` on (m; if empty, from the place nearest to the state).
/// Allocates in the first plan only.
void place_target(const PlannerSettings& settings, const models::SystemDescription& system,
                  const Eigen::VectorXd& state, std::optional<double> progress,
                  QuadraticCost& weights);

}  // namespace qsmpc::controller
