// An episode as charts over time.
#pragma once

#include <vector>

#include "harness/figures/svg_chart.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// Charts over time: certificates with observed outcomes, clearance, each input against its bounds,
/// solve time, parts of the cost, error budget; and the histogram of the solve times. For a trace
/// without steps, they have no points.
[[nodiscard]] std::vector<Chart> episode_charts(const EpisodeView& view);

/// Smaller budgets are drawn at this value on a logarithmic axis.
inline constexpr double kLeastBudget = 1e-3;

/// The scale on which the error budgets of all periods and stages are legible.
[[nodiscard]] Scale budget_scale(const Trace& trace);

}  // namespace qsmpc::harness
