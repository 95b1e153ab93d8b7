// The two states of a system that a map of its drives shows.
#pragma once

#include <optional>

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

}  // namespace qsmpc::harness
