// The two states that a map of a system's drives shows.
#pragma once

#include <optional>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Whether states of `system` have a position in the plane.
[[nodiscard]] bool has_position(const models::SystemDescription& system);

/// Indices of the two states that a map shows.
struct MapAxes {
  int x = 0;
  int y = 0;
  bool is_plane = true;  ///< they are the position in the plane
};

/// The position in the plane. For a system without one: its first position (m), paired with the
/// first angle, or else with the first other state. Nothing if there is no position.
[[nodiscard]] std::optional<MapAxes> map_axes(const models::SystemDescription& system);

}  // namespace qsmpc::harness
