// The map of an episode: safe set, target, driven path, and where the model's state was thought to
// be.
#pragma once

#include <optional>
#include <string>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// None for a system without a position in the plane.
[[nodiscard]] std::optional<PlaneMap> episode_plane_map(const EpisodeView& view);

/// A <figure>; empty for a system without a position in the plane.
[[nodiscard]] std::string episode_map(const EpisodeView& view);

/// What stands still in it: safe set and target, and the part of the plane that it shows. For a
/// system with a position.
[[nodiscard]] PlaneMap episode_ground(const EpisodeView& view);

}  // namespace qsmpc::harness
