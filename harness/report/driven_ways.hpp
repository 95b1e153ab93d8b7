// The obstacles of a drive that move, as maps show them.
#pragma once

#include <vector>

#include "harness/figures/map_movers.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// Where each truly went, and where it was when the vehicle's body was nearest to it, for a system
/// with a position in the plane.
[[nodiscard]] std::vector<MapMover> driven_ways(const EpisodeView& view,
                                                const DrivenObstacles& others);

/// Where each is written, with nothing but its start: of drives that each have other ways.
[[nodiscard]] std::vector<MapMover> written_movers(const controller::SafeSet& safe_set);

/// The scenario without its obstacles that move.
[[nodiscard]] Scenario standing_scenario(Scenario scenario);

}  // namespace qsmpc::harness
