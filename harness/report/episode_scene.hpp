// What the episode's page shows in three dimensions: the vehicle's MuJoCo model along the drive,
// and the plane that it drives in.
#pragma once

#include <string>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct EpisodeScene {
  /// A JSON object that is safe inside of a <script type="application/json">, which web/scene3d.js
  /// says the meaning of; empty where there is nothing to show.
  std::string data{};
  /// What the reader should know: why there is no view, or what it leaves out; empty: nothing.
  std::string note{};
};

/// The scene of a trace with a vehicle to draw (drawn_vehicle), whose file is read again. It has a
/// place for the vehicle: where it was at every sample of the motion or, without a simulator, of
/// `ground`, the plane that it is drawn in (null: none). At control instants a disturbance makes
/// the true state jump: here, each period leads from its first state to the next one's in one go,
/// as in the page's map. A model that cannot be read, or that is not the one that was driven, is
/// left out with a note.
[[nodiscard]] EpisodeScene episode_scene(const EpisodeView& view, const PlaneMap* ground);

}  // namespace qsmpc::harness
