// The map of an episode: safe set, target, driven path, and where the model's state was thought to
// be.
#pragma once

#include <string>

#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

/// A <figure>; empty for a system without a position in the plane.
[[nodiscard]] std::string episode_map(const Trace& trace, const SystemDescription& system);

}  // namespace qsmpc
