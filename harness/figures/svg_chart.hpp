// A line chart as inline SVG, with axes, units, ticks and a legend. Colours and line widths are
// classes of the page's style (page_style.hpp).
//
//   chart_figure({.title = "Clearance", .x_label = "time (s)", .y_label = "clearance (m)",
//                 .series = {{.name = "true state", .x = times, .y = clearances}}});
#pragma once

#include <string>
#include <vector>

#include "harness/figures/axis.hpp"
#include "harness/figures/legend.hpp"

namespace qsmpc::harness {

/// kJoined: points with a thin line from each to the next. kLimits: an arrow down from each point,
/// which only the truth is known to be below of.
enum class Mark { kLine, kSteps, kPoints, kJoined, kLimits };

/// One line of a chart. Where x or y is not finite, the line is interrupted.
struct Series {
  std::string name;
  int colour = 0;  ///< of the page's palette, 0 … kPaletteSize - 1
  Mark mark = Mark::kLine;
  bool dashed = false;
  std::vector<double> x{};
  std::vector<double> y{};  ///< as many as x
  /// Ends of an error bar at each point; empty: none. One with an end that is not finite is not
  /// drawn.
  std::vector<double> lower{};
  std::vector<double> upper{};
  std::vector<double> x_lower{};  ///< the same of a horizontal bar
  std::vector<double> x_upper{};
  /// What stands beside each point, where it hides nothing; empty: nothing.
  std::vector<std::string> labels{};
};

/// A part of the ground that is shaded.
struct Area {
  std::string name;  ///< in the legend
  std::vector<double> x{};
  std::vector<double> y{};  ///< as many as x: the corners
};

/// A horizontal line over the whole chart: a limit.
struct Rule {
  std::string name;    ///< in the legend; empty: not there
  double value = 0.0;  ///< one that is not finite is left out
};

struct Chart {
  std::string title;
  std::string note{};      ///< below the title, in small print
  std::string in_words{};  ///< for those who do not see it; empty: title and label of y
  std::string x_label;
  std::string y_label;
  Scale x_scale = Scale::kLinear;
  Scale y_scale = Scale::kLinear;
  double least_x = 1e-12;      ///< on a logarithmic axis: what is below is drawn at its foot
  bool x_has_zero = false;     ///< on a logarithmic axis: 0 has a place of its own, left of a break
  double least_shown = 1e-12;  ///< the same of y
  bool y_has_zero = false;     ///< on a logarithmic axis: 0 has a place of its own, at the foot
  std::vector<std::string> x_names{};  ///< what stands at x = 1, 2, … in place of numbers
  std::vector<double> x_includes{};    ///< values that the axes must show
  std::vector<double> y_includes{};
  std::vector<Series> series{};
  std::vector<Rule> rules{};
  std::vector<Area> areas{};
};

/// The chart as a <figure>. Its size does not grow with the number of points beyond some
/// thousands: of longer lines, the extremes of short stretches are drawn. Texts are escaped.
[[nodiscard]] std::string chart_figure(const Chart& chart);

/// The drawing of `chart_figure` alone, as an <svg>, kChartWidth x kChartHeight units large and
/// placed at `x`, `y` of what it is put into: axes and lines, without title and legend.
[[nodiscard]] std::string chart_drawing(const Chart& chart, double x = 0.0, double y = 0.0);

/// Whether there is a finite value to draw.
[[nodiscard]] bool has_points(const Chart& chart);

/// What its lines, points and rules mean.
[[nodiscard]] std::vector<LegendEntry> chart_legend(const Chart& chart);

inline constexpr double kChartWidth = 480.0;
inline constexpr double kChartHeight = 290.0;

}  // namespace qsmpc::harness
