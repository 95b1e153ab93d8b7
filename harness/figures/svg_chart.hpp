// A line chart as inline SVG, with axes, units, ticks and a legend. Colours and line widths are
// classes of the page's style (harness/report/web/page.css).
//
//   chart_figure({.title = "Clearance", .x_label = "time (s)", .y_label = "clearance (m)",
//                 .series = {{.name = "true state", .x = times, .y = clearances}}});
#pragma once

#include <string>
#include <vector>

#include "harness/figures/axis.hpp"
#include "harness/figures/legend.hpp"

namespace qsmpc::harness {

/// kJoined: points joined by a thin line. kLimits: upper limits, drawn as an arrow down from each
/// point; the true value is only known to lie below.
enum class Mark { kLine, kSteps, kPoints, kJoined, kLimits };

/// One line of a chart, interrupted where x or y is not finite.
struct Series {
  std::string name;
  int colour = 0;  ///< of the page's palette, 0 … kPaletteSize - 1
  /// Of its points, 0 … kMarkerCount - 1 (chart_marks.hpp); negative: that of the colour.
  int marker = -1;
  Mark mark = Mark::kLine;
  bool dashed = false;
  std::vector<double> x{};
  std::vector<double> y{};  ///< as many as x
  /// Ends of an error bar at each point; empty: no bars. A bar with a non-finite end is not drawn.
  std::vector<double> lower{};
  std::vector<double> upper{};
  std::vector<double> x_lower{};  ///< the same for a horizontal bar
  std::vector<double> x_upper{};
  /// A label beside each point, shown where it hides nothing; empty: no labels.
  std::vector<std::string> labels{};
};

/// A shaded part of the background.
struct Area {
  std::string name;  ///< in the legend
  std::vector<double> x{};
  std::vector<double> y{};  ///< as many as x: the corners
};

/// A horizontal line across the whole chart: a limit.
struct Rule {
  std::string name;    ///< in the legend; empty: no entry
  double value = 0.0;  ///< a non-finite one is left out
};

struct Chart {
  std::string title;
  std::string note{};      ///< below the title, in small print
  std::string in_words{};  ///< for screen readers; empty: title and label of y
  std::string x_label;
  std::string y_label;
  Scale x_scale = Scale::kLinear;
  Scale y_scale = Scale::kLinear;
  double least_x = 1e-12;      ///< on a logarithmic axis: smaller values are drawn at its lower end
  bool x_has_zero = false;     ///< on a logarithmic axis: 0 has a separate place, left of a break
  double least_shown = 1e-12;  ///< the same for y
  bool y_has_zero = false;     ///< on a logarithmic axis: 0 has a separate place, at the foot
  std::vector<std::string> x_names{};  ///< labels at x = 1, 2, … in place of numbers
  std::vector<double> x_includes{};    ///< values that the axes must show
  std::vector<double> y_includes{};
  std::vector<Series> series{};
  std::vector<Rule> rules{};
  std::vector<Area> areas{};
};

/// The chart as a <figure>. Its file size stops growing beyond some thousands of points: of longer
/// lines, the extremes of short stretches are drawn. Texts are escaped.
[[nodiscard]] std::string chart_figure(const Chart& chart);

/// Only the drawing of `chart_figure`, as an <svg> of kChartWidth x kChartHeight units placed at
/// `x`, `y` of the enclosing drawing: axes and lines, without title and legend.
[[nodiscard]] std::string chart_drawing(const Chart& chart, double x = 0.0, double y = 0.0);

/// Whether there is a finite value to draw.
[[nodiscard]] bool has_points(const Chart& chart);

/// The legend of its lines, points and rules.
[[nodiscard]] std::vector<LegendEntry> chart_legend(const Chart& chart);

inline constexpr double kChartWidth = 480.0;
inline constexpr double kChartHeight = 290.0;

}  // namespace qsmpc::harness
