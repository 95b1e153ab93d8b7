// What a cost is about in the plan at hand: the target, or what comes next of a path or
// of waypoints.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/planning/cost/quadratic_cost.hpp"
#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// Makes the targets of `weights` those of a plan from `state` (state_dim): settings.cost.target,
/// nearest modulo 2π, or the next of settings.waypoints after `progress` of them (without it, the
/// first), or along settings.path from `progress` on (m; without it, from where the state is
/// nearest to the path). Allocates in the first plan only.
void place_target(const PlannerSettings& settings, const models::SystemDescription& system,
                  const Eigen::VectorXd& state, std::optional<double> progress,
                  QuadraticCost& weights);

}  // namespace qsmpc::controller
