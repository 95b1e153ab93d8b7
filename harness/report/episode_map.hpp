// The map of an episode: safe set, target, driven path, and where the model's state was thought to
// be.
#pragma once

#include <optional>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct EpisodeMaps {
  PlaneMap drive;   ///< all of the drive
  PlaneMap ground;  ///< what stands still in it, and the part of the plane that it shows
};

/// None for a system without a position in the plane.
[[nodiscard]] std::optional<EpisodeMaps> episode_maps(const EpisodeView& view);

}  // namespace qsmpc::harness
