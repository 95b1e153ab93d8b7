// The map of an episode: safe set, target, driven path, and beliefs about the model's state.
#pragma once

#include <optional>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct EpisodeMaps {
  PlaneMap drive;   ///< the whole drive
  PlaneMap ground;  ///< its static content, and the part of the plane that it shows
  /// For a drive along a path: its line coloured by speed, and by the certified risk of the next
  /// state.
  std::vector<PlaneMap> coloured{};
};

/// The maps of an episode; nothing for a system without a position in the plane.
[[nodiscard]] std::optional<EpisodeMaps> episode_maps(const EpisodeView& view);

}  // namespace qsmpc::harness
