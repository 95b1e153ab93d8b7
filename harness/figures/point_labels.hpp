// Labels beside the points of a chart.
#pragma once

#include <string>

#include "harness/figures/plot_frame.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// The labels of all series as escaped <text> elements, each near its point, within the plot, and
/// where it covers the fewest points, lines and bars. A label that would cover another one is left
/// out.
[[nodiscard]] std::string point_labels(const Chart& chart, const PlotFrame& frame);

}  // namespace qsmpc::harness
