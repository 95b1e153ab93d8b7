// What happened along an episode, as charts over time.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/svg_chart.hpp"
#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Over time: certificates with what was observed, clearance, each input against its bounds, solve
/// time, parts of the cost, error budget; and the histogram of the solve times. Of a trace without
/// steps, they have no points.
[[nodiscard]] std::vector<Chart> episode_charts(const EpisodeView& view);

/// The unit of distances to the unsafe set: that of the states which the safe set restricts, or
/// "state units" where they differ.
[[nodiscard]] std::string clearance_unit(const controller::SafeSet& safe_set,
                                         const models::SystemDescription& system);

}  // namespace qsmpc::harness
