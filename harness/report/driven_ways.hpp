// The moving obstacles of a drive, as shown on maps.
#pragma once

#include <vector>

#include "harness/figures/map_movers.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// The true path of each obstacle, and its pose when the vehicle's body was nearest to it, for a
/// system with a position in the plane.
[[nodiscard]] std::vector<MapMover> driven_ways(const EpisodeView& view,
                                                const DrivenObstacles& others);

/// Each obstacle at its initial pose only, for maps of several drives with different obstacle
/// paths.
[[nodiscard]] std::vector<MapMover> written_movers(const controller::SafeSet& safe_set);

/// The scenario without its moving obstacles.
[[nodiscard]] Scenario standing_scenario(Scenario scenario);

}  // namespace qsmpc::harness
