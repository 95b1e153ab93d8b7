// A scenario's map without any drive.
#pragma once

#include <Eigen/Core>

#include "harness/figures/plane_map.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/map_axes.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The place of `state` (state_dim) on the map, for a system with map_axes; NaN if `state` is too
/// short.
[[nodiscard]] MapPoint map_point(const Eigen::Ref<const Eigen::VectorXd>& state,
                                 const models::SystemDescription& system);

/// Bounds, obstacles, target and the axes' names, for a system with a position. Obstacles that also
/// restrict other states are partial. Axis-aligned rectangles become boxes, however the scenario
/// describes them.
[[nodiscard]] PlaneMap ground_map(const Scenario& scenario,
                                  const models::SystemDescription& system);

}  // namespace qsmpc::harness
