// Error bars of a chart's points.
#pragma once

#include <string>

#include "harness/figures/plot_frame.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// The bars of a series, vertical and horizontal, as data of a path: with a short stroke at either
/// end, and an arrow where a logarithmic x axis cuts the end off. Empty where there is none.
[[nodiscard]] std::string error_bars(const Series& series, const PlotFrame& frame);

}  // namespace qsmpc::harness
