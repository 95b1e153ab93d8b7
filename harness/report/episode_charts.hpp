// What happened along an episode, as charts over time.
#pragma once

#include <vector>

#include "harness/figures/svg_chart.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// Over time: certificates with what was observed, clearance, each input against its bounds, solve
/// time, parts of the cost, error budget; and the histogram of the solve times. Of a trace without
/// steps, they have no points.
[[nodiscard]] std::vector<Chart> episode_charts(const EpisodeView& view);

}  // namespace qsmpc::harness
