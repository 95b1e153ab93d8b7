// The map of an episode: safe set, target, driven path, and where the model's state was thought to
// be.
#pragma once

#include <optional>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct EpisodeMaps {
  PlaneMap drive;   ///< all of the drive
  PlaneMap ground;  ///< what stands still in it, and the part of the plane that it shows
  /// Of a drive along a path: its line by the speed, and by the certified risk of the next state.
  std::vector<PlaneMap> coloured{};
};

/// None for a system without a position in the plane.
[[nodiscard]] std::optional<EpisodeMaps> episode_maps(const EpisodeView& view);

}  // namespace qsmpc::harness
