#include "harness/figures/svg_chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/chart_marks.hpp"
#include "harness/figures/error_bars.hpp"
#include "harness/figures/palette.hpp"
#include "harness/figures/plot_frame.hpp"
#include "harness/figures/point_labels.hpp"
#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kWidth = kChartWidth;
constexpr double kHeight = kChartHeight;
constexpr const char* kAreaClass = "area";
constexpr std::size_t kMostPoints = 1000;  // per line; more would not be visible
constexpr std::size_t kMarksOnLine = 8;    // if it has many points
constexpr double kNameSize = 14.5;         // font size on a telephone, where it is largest
constexpr std::size_t kAllMarked = 12;     // a line of up to this many points has a mark at each

int marker_of(const Series& series) {
  return series.marker < 0 ? palette_index(series) : std::min(series.marker, kMarkerCount - 1);
}

/// The points to draw: of each stretch of a long line, its minimum and maximum in their order; of a
/// stretch with a gap, also the gap.
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

struct PathData {
  std::string line;
  std::string dots;  ///< isolated points
};

/// A bar at an upper limit, and an arrow down from it.
std::string limit_arrow(double x, double y) {
  return fmt::format("M{:.1f} {:.1f}h8M{:.1f} {:.1f}v11m-3 -4l3 4l3 -4", x - 4.0, y, x, y);
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
    if (series.mark == Mark::kJoined) data.dots += mark_data(marker_of(series), x, y);
    if (series.mark == Mark::kLimits) {
      data.line += limit_arrow(x, y);
    } else if (series.mark == Mark::kJoined) {
      data.line += fmt::format("{}{:.1f} {:.1f}", begins ? "M" : "L", x, y);
    } else if (series.mark == Mark::kPoints || (begins && !shown(n + 1))) {
      data.dots += mark_data(marker_of(series), x, y);
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

/// Whether a line has markers that distinguish it from others.
bool is_marked(const Series& series) { return series.mark == Mark::kLine && !series.dashed; }
bool has_marks(const Chart& chart, const Series& series) {
  return is_marked(series) && std::ranges::count_if(chart.series, is_marked) > 1;
}

/// Markers along a line, at places that depend on its colour.
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
    data += mark_data(marker_of(series), frame.across(series.x[i]), frame.up(series.y[i]));
  }
  return data;
}

std::string marks_svg(const Series& series, const std::string& data) {
  return fmt::format("<path class=\"{}\" d=\"{}\"/>",
                     mark_classes(palette_index(series), marker_of(series)), data);
}

std::string line_classes(const Series& series) {
  return fmt::format("{} c{}{}", series.mark == Mark::kJoined ? "way faint" : "line",
                     palette_index(series), series.dashed ? " dash" : "");
}

/// `label` for values that are shown divided by 10^`power`: "x (10⁻⁵ m)" for "x (m)".
std::string with_power(const std::string& label, int power) {
  if (power == 0) return label;
  const std::string factor = format_power_of_ten(power);
  const std::size_t unit = label.rfind('(');
  if (unit == std::string::npos) return label + " (" + factor + ")";
  const bool has_unit = label.compare(unit, std::string::npos, "(–)") != 0;
  return label.substr(0, unit + 1) + factor + (has_unit ? " " + label.substr(unit + 1) : ")");
}

/// Ticks at values, with labels divided by 10^`power`.
std::vector<Tick> ticks_up(const Axis& axis, int power) {
  const double unit = std::pow(10.0, power);
  Axis shown = axis;
  if (power != 0) {
    shown.lower /= unit;
    shown.upper /= unit;
  }
  std::vector<Tick> ticks = ticks_of(shown, kTicksUp);
  if (power != 0) {
    for (Tick& tick : ticks) tick.value *= unit;
  }
  return ticks;
}

std::vector<Tick> ticks_across(const Chart& chart, const PlotFrame& frame) {
  if (chart.x_names.empty()) return ticks_of(frame.x, kTicksAcross);
  std::vector<Tick> ticks;
  for (const std::string& name : chart.x_names) {
    ticks.push_back({static_cast<double>(ticks.size() + 1), name});
  }
  return ticks;
}

/// Path data of the break between the place of 0 and the rest of a logarithmic x axis: a gap with a
/// stroke at either side; empty without such a place.
std::string axis_break(const PlotFrame& frame, double foot) {
  if (frame.x.zero_share <= 0.0) return {};
  const double x = 0.5 * (frame.across(0.0) + frame.across(frame.x.lower));
  return fmt::format("H{0:.1f}m-2 4l4 -8m4 0l-4 8M{1:.1f} {2:.1f}", x - 2.0, x + 2.0, foot);
}

/// The same for the y axis, from its top on.
std::string axis_break_up(const PlotFrame& frame) {
  if (frame.y.zero_share <= 0.0) return {};
  const double y = 0.5 * (frame.up(0.0) + frame.up(frame.y.lower));
  return fmt::format("V{0:.1f}m-4 2l8 -4m0 4l-8 4M{1:.1f} {2:.1f}", y - 2.0, kChartLeft, y + 2.0);
}

/// The label of the y axis, reading upwards and centred at `middle`; in two lines if one would
/// leave the drawing.
std::string y_label_svg(const std::string& label, double middle) {
  const auto line = [&](int x, const std::string& text) {
    return fmt::format(
        "<text class=\"middle label\" transform=\"translate({} {:.1f}) rotate(-90)\">{}</text>", x,
        middle, escape_html(text));
  };
  const double room = 2.0 * std::min(middle, kHeight - middle);
  if (estimated_width(label, kNameSize) <= room) return line(14, label);
  const std::size_t half = label.find(' ', label.size() / 2);
  if (half == std::string::npos) return line(14, label);
  return line(11, label.substr(0, half)) + line(25, label.substr(half + 1));
}

/// The middle of the name below the axis that belongs to `x`, kept within the drawing.
double name_place(double x, const std::string& name) {
  const double half = 0.5 * estimated_width(name, kNameSize);
  return std::max(std::min(x, kWidth - half), half);
}

/// Whether two neighbouring names below the axis would touch; names are then set in two rows.
bool are_staggered(const Chart& chart, const PlotFrame& frame) {
  constexpr double kNameGap = 6.0;
  for (std::size_t n = 0; n + 1 < chart.x_names.size(); ++n) {
    const double width = 0.5 * (estimated_width(chart.x_names[n], kNameSize) +
                                estimated_width(chart.x_names[n + 1], kNameSize));
    const double at = static_cast<double>(n + 1);
    if (width + kNameGap > frame.across(at + 1.0) - frame.across(at)) return true;
  }
  return false;
}

std::string axes_svg(const Chart& chart, const PlotFrame& frame) {
  const double right = kWidth - kChartRight;
  const double foot = kHeight - kChartBottom;
  const int power = common_power(frame.y, kTicksUp);
  std::string svg;
  for (const Tick& tick : ticks_up(frame.y, power)) {
    const double y = frame.up(tick.value);
    svg += fmt::format("<path class=\"grid-line\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", kChartLeft, y,
                       right);
    svg += fmt::format("<text class=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", kChartLeft - 7.0,
                       y + 4.0, escape_html(tick.label));
  }
  const bool staggered = are_staggered(chart, frame);
  std::size_t ticks = 0;
  for (const Tick& tick : ticks_across(chart, frame)) {
    const double drop = staggered && ticks++ % 2 == 1 ? 34.0 : 18.0;
    const double x = frame.across(tick.value);
    svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}v5\"/>", x, foot);
    svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                       chart.x_names.empty() ? x : name_place(x, tick.label), foot + drop,
                       escape_html(tick.label));
  }
  std::string minor;
  for (const Tick& tick : minor_ticks_of(frame.x)) {
    minor += fmt::format("M{:.1f} {:.1f}v3", frame.across(tick.value), foot);
  }
  if (!minor.empty()) svg += fmt::format("<path class=\"axis\" d=\"{}\"/>", minor);
  svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}{}V{:.1f}{}H{:.1f}\"/>", kChartLeft,
                     kChartTop, axis_break_up(frame), foot, axis_break(frame, foot), right);
  svg += fmt::format("<text class=\"middle label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                     (kChartLeft + right) / 2.0, kHeight - 8.0,
                     staggered ? "" : escape_html(chart.x_label));
  return svg + y_label_svg(with_power(chart.y_label, power), (kChartTop + foot) / 2.0);
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

/// States what the drawing leaves out; empty if nothing.
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
    if (series.mark == Mark::kPoints || series.mark == Mark::kJoined || has_marks(chart, series)) {
      entry.drawing +=
          marks_svg(series, mark_data(marker_of(series), kSwatchWidth / 2.0, kSwatchHeight / 2.0));
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
  // Only if embedded in another drawing; a page leaves position and size to its style.
  const std::string place =
      x == 0.0 && y == 0.0 ? ""
                           : fmt::format(" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"", x,
                                         y, kWidth, kHeight);
  std::string svg = fmt::format(
      "<svg{} viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", place, kWidth, kHeight,
      escape_html(chart.in_words.empty() ? chart.title + ": " + chart.y_label : chart.in_words));
  svg += areas_svg(chart, frame) + axes_svg(chart, frame);
  for (const Rule& rule : chart.rules) {
    if (!is_drawable(rule.value)) continue;
    svg += fmt::format("<path class=\"rule\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", kChartLeft,
                       frame.up(rule.value), kWidth - kChartRight);
  }
  for (const Series& series : chart.series) {
    const PathData data = path_data(series, frame);
    const std::string bars = error_bars(series, frame);
    if (!bars.empty()) {
      svg += fmt::format("<path class=\"line{} c{}\" d=\"{}\"/>",
                         series.mark == Mark::kJoined ? " thin" : "", palette_index(series), bars);
    }
    if (!data.line.empty()) {
      svg += fmt::format("<path class=\"{}\" d=\"{}\"/>", line_classes(series), data.line);
    }
    const std::string marks =
        data.dots + (has_marks(chart, series) ? line_marks(series, frame) : std::string());
    if (!marks.empty()) svg += marks_svg(series, marks);
  }
  return svg + point_labels(chart, frame) + "</svg>\n";
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
