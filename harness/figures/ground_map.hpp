// What a scenario's map shows before anything drives on it.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "harness/figures/plane_map.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Whether states of `system` have a place in the plane.
[[nodiscard]] bool has_position(const models::SystemDescription& system);

/// Two states that a map shows.
struct MapAxes {
  int x = 0;
  int y = 0;
  bool is_plane = true;  ///< they are the position in the plane
};

/// The position in the plane; of a system without one, its first position (m) and beside it the
/// first angle, else the first other state. Nothing where there is no position.
[[nodiscard]] std::optional<MapAxes> map_axes(const models::SystemDescription& system);

/// Where `state` (state_dim) is, for a system with map_axes; not a number where it is too short.
[[nodiscard]] MapPoint map_point(const Eigen::Ref<const Eigen::VectorXd>& state,
                                 const models::SystemDescription& system);

/// Bounds, obstacles, target and the axes' names, for a system with a position. Obstacles that
/// restrict other states too are partial.
[[nodiscard]] PlaneMap ground_map(const Scenario& scenario,
                                  const models::SystemDescription& system);

}  // namespace qsmpc::harness
