// What a scenario's map shows before anything drives on it.
#pragma once

#include <Eigen/Core>

#include "harness/figures/plane_map.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/map_axes.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Where `state` (state_dim) is, for a system with map_axes; not a number where it is too short.
[[nodiscard]] MapPoint map_point(const Eigen::Ref<const Eigen::VectorXd>& state,
                                 const models::SystemDescription& system);

/// Bounds, obstacles, target and the axes' names, for a system with a position. Obstacles that
/// restrict other states too are partial. Rectangles along the axes are boxes, whatever they are
/// called in the scenario.
[[nodiscard]] PlaneMap ground_map(const Scenario& scenario,
                                  const models::SystemDescription& system);

}  // namespace qsmpc::harness
