// Which vehicle the pictures of an episode show, and where it is drawn for systems without a
// position in the plane.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Whether a system has no position in the plane but moves along a line, and is drawn on a rail.
[[nodiscard]] bool is_on_rail(const models::SystemDescription& system);

/// Index of the state that is drawn along x: the first position (m) of a system on a rail; -1 for
/// none.
[[nodiscard]] int drawn_x(const models::SystemDescription& system);

/// The file of the drawn vehicle: that of the scenario, or the one shipped for a system on a rail;
/// empty if there is none.
[[nodiscard]] std::string drawn_vehicle(const EpisodeView& view);

}  // namespace qsmpc::harness
