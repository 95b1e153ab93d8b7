// The reference of a plan's cost where there may be a guide.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/planning/guide/guide.hpp"
#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// The guide, if `settings` ask for one. Throws as Guide does.
[[nodiscard]] std::optional<Guide> make_guide(const models::Dynamics& dynamics,
                                              const PlannerSettings& settings);

/// Sets the targets of `weights` for a plan from `state` (state_dim): the guide's aim, nearest
/// modulo 2π; without a guide, as place_target does (placed_target.hpp).
void place_guided_target(std::optional<Guide>& guide, const PlannerSettings& settings,
                         const models::SystemDescription& system, const Eigen::VectorXd& state,
                         std::optional<double> progress, QuadraticCost& weights);

}  // namespace qsmpc::controller
