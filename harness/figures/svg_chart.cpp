#include "harness/figures/svg_chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/chart_marks.hpp"
#include "harness/figures/palette.hpp"
#include "harness/text/html.hpp"

namespace qsmpc::harness {
namespace {

// Units of the view box; the page scales it to the width that there is.
constexpr double kWidth = kChartWidth;
constexpr double kHeight = kChartHeight;
constexpr double kChartLeft = 78.0;
constexpr double kChartRight = 14.0;
constexpr double kChartTop = 10.0;
constexpr double kChartBottom = 46.0;
constexpr const char* kAreaClass = "area";
constexpr int kTicksAcross = 6;
constexpr int kTicksUp = 5;
constexpr std::size_t kMostPoints = 1000;  // of a line; more would not be seen
constexpr std::size_t kMarksOnLine = 8;    // where it has many points
constexpr std::size_t kAllMarked = 12;     // a line of so many points has a mark at each

struct PlotFrame {
  Axis x;
  Axis y;

  [[nodiscard]] double across(double value) const {
    return kChartLeft + position_on(x, value) * (kWidth - kChartLeft - kChartRight);
  }
  [[nodiscard]] double up(double value) const {
    return kHeight - kChartBottom - position_on(y, value) * (kHeight - kChartTop - kChartBottom);
  }
};

bool is_shown(const Series& series, std::size_t i) {
  return is_drawable(series.x[i]) && is_drawable(series.y[i]);
}

bool has_bar(const Series& series, std::size_t i) {
  return i < series.lower.size() && i < series.upper.size() && is_drawable(series.lower[i]) &&
         is_drawable(series.upper[i]);
}

/// Of each stretch of a long line, its least and its greatest value in the order of their times;
/// of one with a gap, the gap too.
std::vector<std::size_t> drawn_indices(const Series& series) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const std::size_t stretch =
      count <= kMostPoints ? 1 : (count + kMostPoints / 2 - 1) / (kMostPoints / 2);
  std::vector<std::size_t> indices;
  for (std::size_t begin = 0; begin < count; begin += stretch) {
    const std::size_t end = std::min(begin + stretch, count);
    std::vector<std::size_t> kept = {begin, begin};
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_shown(series, i)) {
        kept.push_back(i);
        break;
      }
      if (series.y[i] < series.y[kept[0]]) kept[0] = i;
      if (series.y[i] > series.y[kept[1]]) kept[1] = i;
    }
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    indices.insert(indices.end(), kept.begin(), kept.end());
  }
  return indices;
}

int palette_index(const Series& series) { return std::clamp(series.colour, 0, kPaletteSize - 1); }

struct PathData {
  std::string line;
  std::string dots;  ///< points that no line leads to
};

/// A bar at an upper limit, and an arrow down from it.
std::string limit_arrow(double x, double y) {
  return fmt::format("M{:.1f} {:.1f}h8M{:.1f} {:.1f}v11m-3 -4l3 4l3 -4", x - 4.0, y, x, y);
}

/// Error bars with a short stroke at either end.
std::string bars_data(const Series& series, const PlotFrame& frame) {
  const std::size_t count = std::min({series.x.size(), series.lower.size(), series.upper.size()});
  std::string data;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_drawable(series.x[i]) || !has_bar(series, i)) continue;
    const double x = frame.across(series.x[i]);
    const double low = frame.up(series.lower[i]);
    const double high = frame.up(series.upper[i]);
    data += fmt::format("M{0:.1f} {1:.1f}h6m-3 0V{2:.1f}m-3 0h6", x - 3.0, low, high);
  }
  return data;
}

PathData path_data(const Series& series, const PlotFrame& frame) {
  const std::vector<std::size_t> indices = drawn_indices(series);
  const auto shown = [&](std::size_t n) {
    return n < indices.size() && is_shown(series, indices[n]);
  };
  PathData data;
  for (std::size_t n = 0; n < indices.size(); ++n) {
    if (!shown(n)) continue;
    const double x = frame.across(series.x[indices[n]]);
    const double y = frame.up(series.y[indices[n]]);
    const bool begins = n == 0 || !shown(n - 1);
    if (series.mark == Mark::kLimits) {
      data.line += limit_arrow(x, y);
    } else if (series.mark == Mark::kPoints || (begins && !shown(n + 1))) {
      data.dots += mark_data(palette_index(series), x, y);
    } else if (begins) {
      data.line += fmt::format("M{:.1f} {:.1f}", x, y);
    } else if (series.mark == Mark::kSteps) {
      data.line += fmt::format("H{:.1f}V{:.1f}", x, y);
    } else {
      data.line += fmt::format("L{:.1f} {:.1f}", x, y);
    }
  }
  return data;
}

/// Whether a line has signs along it, by which it can be told from others.
bool is_marked(const Series& series) { return series.mark == Mark::kLine && !series.dashed; }
bool has_marks(const Chart& chart, const Series& series) {
  return is_marked(series) && std::ranges::count_if(chart.series, is_marked) > 1;
}

/// Signs along a line, at other places for another colour.
std::string line_marks(const Series& series, const PlotFrame& frame) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (is_shown(series, i)) shown.push_back(i);
  }
  const std::size_t marks = shown.size() <= kAllMarked ? shown.size() : kMarksOnLine;
  const int colour = palette_index(series);
  std::string data;
  for (std::size_t n = 0; n < marks; ++n) {
    const std::size_t place = (n * kPaletteSize + static_cast<std::size_t>(colour)) * shown.size() /
                              (marks * kPaletteSize);
    const std::size_t i = shown[marks == shown.size() ? n : place];
    data += mark_data(colour, frame.across(series.x[i]), frame.up(series.y[i]));
  }
  return data;
}

std::string marks_svg(const Series& series, const std::string& data) {
  return fmt::format("<path class=\"{}\" d=\"{}\"/>", mark_classes(palette_index(series)), data);
}

std::string line_classes(const Series& series) {
  return fmt::format("line c{}{}", palette_index(series), series.dashed ? " dash" : "");
}

PlotFrame frame_of(const Chart& chart) {
  std::vector<double> across = chart.x_includes;
  std::vector<double> up = chart.y_includes;
  for (const Series& series : chart.series) {
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (!is_shown(series, i)) continue;
      across.push_back(series.x[i]);
      up.push_back(series.y[i]);
      if (!has_bar(series, i)) continue;
      up.push_back(series.upper[i]);
      // The lower end of a rate may be almost 0: a logarithmic axis cuts it off.
      if (chart.y_scale == Scale::kLinear) up.push_back(series.lower[i]);
    }
  }
  for (const Rule& rule : chart.rules) up.push_back(rule.value);
  return {.x = chart.x_scale == Scale::kLog ? log_axis(across, chart.least_x) : tight_axis(across),
          .y = chart.y_scale == Scale::kLog ? log_axis(up, chart.least_shown)
                                            : rounded_axis(up, kTicksUp)};
}

std::vector<Tick> ticks_across(const Chart& chart, const PlotFrame& frame) {
  if (chart.x_names.empty()) return ticks_of(frame.x, kTicksAcross);
  std::vector<Tick> ticks;
  for (const std::string& name : chart.x_names) {
    ticks.push_back({static_cast<double>(ticks.size() + 1), name});
  }
  return ticks;
}

std::string axes_svg(const Chart& chart, const PlotFrame& frame) {
  const double right = kWidth - kChartRight;
  const double foot = kHeight - kChartBottom;
  std::string svg;
  for (const Tick& tick : ticks_of(frame.y, kTicksUp)) {
    const double y = frame.up(tick.value);
    svg += fmt::format("<path class=\"grid-line\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", kChartLeft, y,
                       right);
    svg += fmt::format("<text class=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", kChartLeft - 7.0,
                       y + 4.0, escape_html(tick.label));
  }
  for (const Tick& tick : ticks_across(chart, frame)) {
    const double x = frame.across(tick.value);
    svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}v5\"/>", x, foot);
    svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x, foot + 18.0,
                       escape_html(tick.label));
  }
  svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\"/>", kChartLeft,
                     kChartTop, foot, right);
  svg += fmt::format("<text class=\"middle label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                     (kChartLeft + right) / 2.0, kHeight - 8.0, escape_html(chart.x_label));
  svg += fmt::format(
      "<text class=\"middle label\" transform=\"translate(14 {:.1f}) rotate(-90)\">{}</text>",
      (kChartTop + foot) / 2.0, escape_html(chart.y_label));
  return svg;
}

std::string areas_svg(const Chart& chart, const PlotFrame& frame) {
  std::string svg;
  for (const Area& area : chart.areas) {
    std::string data;
    for (std::size_t i = 0; i < std::min(area.x.size(), area.y.size()); ++i) {
      data += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", frame.across(area.x[i]),
                          frame.up(area.y[i]));
    }
    if (!data.empty()) svg += fmt::format("<path class=\"{}\" d=\"{}Z\"/>", kAreaClass, data);
  }
  return svg;
}

/// What the drawing leaves out, so that nothing is hidden; empty if nothing is.
std::string omissions(const Chart& chart) {
  std::size_t broken = 0;
  for (const Series& series : chart.series) {
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (!is_shown(series, i)) ++broken;
    }
  }
  if (broken == 0) return {};
  return fmt::format("<p class=\"note\">{} value{} not finite and not drawn.</p>\n", broken,
                     broken == 1 ? " is" : "s are");
}

}  // namespace

std::vector<LegendEntry> chart_legend(const Chart& chart) {
  std::vector<LegendEntry> entries;
  for (const Area& area : chart.areas) entries.push_back(area_entry(kAreaClass, area.name));
  for (const Series& series : chart.series) {
    if (series.mark == Mark::kLimits) {
      entries.push_back(
          {.drawing = fmt::format("<path class=\"{}\" d=\"{}\"/>", line_classes(series),
                                  limit_arrow(kSwatchWidth / 2.0, 1.0)),
           .name = series.name});
      continue;
    }
    LegendEntry entry = line_entry(line_classes(series), series.name);
    if (series.mark == Mark::kPoints) entry.drawing.clear();
    if (series.mark == Mark::kPoints || has_marks(chart, series)) {
      entry.drawing += marks_svg(
          series, mark_data(palette_index(series), kSwatchWidth / 2.0, kSwatchHeight / 2.0));
    }
    entries.push_back(std::move(entry));
  }
  for (const Rule& rule : chart.rules) {
    if (!rule.name.empty() && is_drawable(rule.value)) {
      entries.push_back(line_entry("rule", rule.name));
    }
  }
  return entries;
}

bool has_points(const Chart& chart) {
  return std::any_of(chart.series.begin(), chart.series.end(), [](const Series& series) {
    const std::size_t count = std::min(series.x.size(), series.y.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (is_shown(series, i)) return true;
    }
    return false;
  });
}

std::string chart_drawing(const Chart& chart, double x, double y) {
  const PlotFrame frame = frame_of(chart);
  // Only where it is put into another drawing; a page leaves place and size to its style.
  const std::string place =
      x == 0.0 && y == 0.0 ? ""
                           : fmt::format(" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"", x,
                                         y, kWidth, kHeight);
  std::string svg =
      fmt::format("<svg{} viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", place, kWidth,
                  kHeight, escape_html(chart.title + ": " + chart.y_label));
  svg += areas_svg(chart, frame) + axes_svg(chart, frame);
  for (const Rule& rule : chart.rules) {
    if (!is_drawable(rule.value)) continue;
    svg += fmt::format("<path class=\"rule\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", kChartLeft,
                       frame.up(rule.value), kWidth - kChartRight);
  }
  for (const Series& series : chart.series) {
    const PathData data = path_data(series, frame);
    const std::string bars = bars_data(series, frame);
    if (!bars.empty()) {
      svg += fmt::format("<path class=\"line c{}\" d=\"{}\"/>", palette_index(series), bars);
    }
    if (!data.line.empty()) {
      svg += fmt::format("<path class=\"{}\" d=\"{}\"/>", line_classes(series), data.line);
    }
    const std::string marks =
        data.dots + (has_marks(chart, series) ? line_marks(series, frame) : std::string());
    if (!marks.empty()) svg += marks_svg(series, marks);
  }
  return svg + "</svg>\n";
}

std::string chart_figure(const Chart& chart) {
  std::string html =
      "<figure class=\"card\">\n<figcaption>" + escape_html(chart.title) + "</figcaption>\n";
  if (!chart.note.empty()) html += "<p class=\"note\">" + escape_html(chart.note) + "</p>\n";
  if (has_points(chart)) {
    html += legend_html(chart_legend(chart)) + chart_drawing(chart);
  } else {
    html += "<p class=\"empty\">No finite values to draw.</p>\n";
  }
  return html + omissions(chart) + "</figure>\n";
}

}  // namespace qsmpc::harness
