// Error bars of a chart's points.
#pragma once

#include <string>

#include "harness/figures/plot_frame.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// The vertical and horizontal bars of a series as path data, with a short stroke at either end, or
/// an arrow if a logarithmic x axis cuts the end off. Empty if there are none.
[[nodiscard]] std::string error_bars(const Series& series, const PlotFrame& frame);

}  // namespace qsmpc::harness
