// The three-dimensional view on an episode's page: the vehicle's MuJoCo model along the drive, and
// the plane in which it drives.
#pragma once

#include <string>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct EpisodeScene {
  /// A JSON object that is safe inside a <script type="application/json">; web/scene3d.js documents
  /// its meaning. Empty if there is nothing to show.
  std::string data{};
  /// A note for the reader: why there is no view, or what it leaves out; empty if there is nothing
  /// to say.
  std::string note{};
};

/// The scene of a trace with a vehicle to draw (drawn_vehicle), whose file is reread. The vehicle
/// is placed where it was at every sample of the motion or, without a simulator, in `ground`, the
/// plane in which it is drawn (null: none). At control instants a disturbance makes the true state
/// jump; here, each period leads continuously from its first state to that of the next period, as
/// in the page's map. A model that cannot be read, or that is not the one that was driven, is left
/// out with a note.
[[nodiscard]] EpisodeScene episode_scene(const EpisodeView& view, const PlaneMap* ground);

}  // namespace qsmpc::harness
