// Maps a chart's values to positions in its drawing; shared by the files that draw its parts.
#pragma once

#include <cstddef>

#include "harness/figures/axis.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

// The plot's margins within the drawing, in units of the view box; the page scales the drawing to
// the available width.
inline constexpr double kChartLeft = 78.0;
inline constexpr double kChartRight = 14.0;
inline constexpr double kChartTop = 10.0;
inline constexpr double kChartBottom = 46.0;
inline constexpr int kTicksAcross = 6;
inline constexpr int kTicksUp = 5;

struct PlotFrame {
  Axis x;
  Axis y;

  /// Map a value to units of the view box.
  [[nodiscard]] double across(double value) const {
    return kChartLeft + position_on(x, value) * (kChartWidth - kChartLeft - kChartRight);
  }
  [[nodiscard]] double up(double value) const {
    return kChartHeight - kChartBottom -
           position_on(y, value) * (kChartHeight - kChartTop - kChartBottom);
  }
};

/// The axes around everything that a chart draws.
[[nodiscard]] PlotFrame frame_of(const Chart& chart);

/// Whether point `i` can be drawn, and whether its vertical or its horizontal bar can.
[[nodiscard]] bool is_shown(const Series& series, std::size_t i);
[[nodiscard]] bool has_bar(const Series& series, std::size_t i);
[[nodiscard]] bool has_bar_across(const Series& series, std::size_t i);

/// The colour of a series, within the palette.
[[nodiscard]] int palette_index(const Series& series);

}  // namespace qsmpc::harness
