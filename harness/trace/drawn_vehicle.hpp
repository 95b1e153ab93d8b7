// Which vehicle pictures of an episode show, and where systems without a plane put it.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Whether a system has no place in the plane, but moves along a line: it is drawn on a rail.
[[nodiscard]] bool is_on_rail(const models::SystemDescription& system);

/// The state that is drawn along x: the first position (m) of a system on a rail; -1 for none.
[[nodiscard]] int drawn_x(const models::SystemDescription& system);

/// The file of the vehicle that is drawn: that of the scenario, or the one shipped for a system on
/// a rail; empty where there is none.
[[nodiscard]] std::string drawn_vehicle(const EpisodeView& view);

}  // namespace qsmpc::harness
