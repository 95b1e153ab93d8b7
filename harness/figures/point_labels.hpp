// What stands beside the points of a chart.
#pragma once

#include <string>

#include "harness/figures/plot_frame.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// The labels of all series as <text> elements, each near its point, within the plot, and where it
/// covers least of points, lines and bars. One that would cover another label is left out. Escaped.
[[nodiscard]] std::string point_labels(const Chart& chart, const PlotFrame& frame);

}  // namespace qsmpc::harness
