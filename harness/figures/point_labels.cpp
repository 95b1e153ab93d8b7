#include "harness/figures/point_labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "harness/text/html.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

// Units of the view box.
constexpr double kLabelSize = 12.5;    // font size, as in the page's style
constexpr double kLabelDescent = 3.0;  // of letters below the baseline
constexpr double kLabelAway = 8.0;     // distance of a label from its point
constexpr double kLabelAir = 2.0;      // between two labels
constexpr double kInkSpacing = 3.0;    // spacing of the points that represent a line
constexpr double kMarkInk = 6.0;       // cost of covering a point's mark, in points of a line
constexpr double kAwayInk = 0.3;       // cost per unit of distance

constexpr double kWrongMarkInk = 6.0;  // cost of a nearer mark of another point

struct InkSpot {
  double x = 0.0;
  double y = 0.0;
  double weight = 1.0;
};

struct LabelBox {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double away = 0.0;  ///< distance from its point

  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + kLabelSize; }
};

void add_stroke(double x0, double y0, double x1, double y1, std::vector<InkSpot>& ink) {
  const int count = 1 + static_cast<int>(std::hypot(x1 - x0, y1 - y0) / kInkSpacing);
  for (int n = 0; n <= count; ++n) {
    const double share = static_cast<double>(n) / count;
    ink.push_back({.x = x0 + share * (x1 - x0), .y = y0 + share * (y1 - y0)});
  }
}

/// Adds what a label should not cover.
void add_ink(const Series& series, const PlotFrame& frame, std::vector<InkSpot>& ink) {
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (!is_shown(series, i)) continue;
    const double x = frame.across(series.x[i]);
    const double y = frame.up(series.y[i]);
    ink.push_back({.x = x, .y = y, .weight = kMarkInk});
    if (has_bar(series, i)) {
      add_stroke(x, frame.up(series.lower[i]), x, frame.up(series.upper[i]), ink);
    }
    if (has_bar_across(series, i)) {
      add_stroke(frame.across(series.x_lower[i]), y, frame.across(series.x_upper[i]), y, ink);
    }
    if (series.mark != Mark::kPoints && i > 0 && is_shown(series, i - 1)) {
      add_stroke(frame.across(series.x[i - 1]), frame.up(series.y[i - 1]), x, y, ink);
    }
  }
}

/// Candidate places around a point for a label of `width`, the preferred one first.
std::vector<LabelBox> boxes_about(double x, double y, double width) {
  std::vector<LabelBox> boxes;
  for (const double away : {kLabelAway, 1.7 * kLabelAway, 2.6 * kLabelAway}) {
    const double above = y - away - kLabelSize + 3.0;
    const double below = y + away - 3.0;
    for (const double top : {above, below}) {
      for (const double left : {x + away - 3.0, x - away + 3.0 - width, x - 0.5 * width}) {
        boxes.push_back({.left = left, .top = top, .width = width, .away = away});
      }
    }
    for (const double left : {x + away, x - away - width}) {
      boxes.push_back({.left = left, .top = y - 0.5 * kLabelSize, .width = width, .away = away});
    }
  }
  return boxes;
}

bool is_in_plot(const LabelBox& box) {
  return box.left > kChartLeft && box.right() < kChartWidth - kChartRight + 6.0 && box.top > 0.0 &&
         box.bottom() < kChartHeight - kChartBottom;
}

bool is_free(const LabelBox& box, const std::vector<LabelBox>& taken) {
  return std::ranges::none_of(taken, [&](const LabelBox& other) {
    return box.left < other.right() + kLabelAir && other.left < box.right() + kLabelAir &&
           box.top < other.bottom() && other.top < box.bottom();
  });
}

double distance_to(const LabelBox& box, double x, double y) {
  return std::hypot(std::max({box.left - x, x - box.right(), 0.0}),
                    std::max({box.top - y, y - box.bottom(), 0.0}));
}

/// Cost of a place, in covered points of a line. A label nearer to another point's mark than to its
/// own would be attributed to that other point.
double cost_of_box(const LabelBox& box, const std::vector<InkSpot>& ink) {
  double cost = kAwayInk * box.away;
  for (const InkSpot& spot : ink) {
    const double distance = distance_to(box, spot.x, spot.y);
    if (distance < 1.0) cost += spot.weight;
    if (spot.weight > 1.0 && distance < 0.8 * box.away) cost += kWrongMarkInk;
  }
  return cost;
}

std::optional<LabelBox> best_box(const std::vector<LabelBox>& boxes,
                                 const std::vector<LabelBox>& taken,
                                 const std::vector<InkSpot>& ink) {
  std::optional<LabelBox> best;
  double least = std::numeric_limits<double>::infinity();
  for (const LabelBox& box : boxes) {
    if (!is_in_plot(box) || !is_free(box, taken)) continue;
    const double cost = cost_of_box(box, ink);
    if (cost < least) {
      least = cost;
      best = box;
    }
  }
  return best;
}

}  // namespace

std::string point_labels(const Chart& chart, const PlotFrame& frame) {
  const bool any = std::ranges::any_of(chart.series,
                                       [](const Series& series) { return !series.labels.empty(); });
  if (!any) return {};
  std::vector<InkSpot> ink;
  for (const Series& series : chart.series) add_ink(series, frame, ink);
  std::vector<LabelBox> taken;
  std::string svg;
  for (const Series& series : chart.series) {
    for (std::size_t i = 0; i < std::min(series.labels.size(), series.x.size()); ++i) {
      if (!is_shown(series, i) || series.labels[i].empty()) continue;
      const double width = estimated_width(series.labels[i], kLabelSize);
      const auto box = best_box(
          boxes_about(frame.across(series.x[i]), frame.up(series.y[i]), width), taken, ink);
      if (!box) continue;
      taken.push_back(*box);
      svg += fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", box->left,
                         box->bottom() - kLabelDescent, escape_html(series.labels[i]));
    }
  }
  return svg;
}

}  // namespace qsmpc::harness
