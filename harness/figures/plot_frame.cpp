#include "harness/figures/plot_frame.hpp"

#include <algorithm>
#include <vector>

#include "harness/figures/palette.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kZeroShare = 0.15;  // of an axis with a separate place for 0

bool has_ends(const std::vector<double>& lower, const std::vector<double>& upper, std::size_t i) {
  return i < lower.size() && i < upper.size() && is_drawable(lower[i]) && is_drawable(upper[i]);
}

/// Adds what the axes must show: a point, and the ends of its bars. The lower end of a rate's bar
/// may be almost 0: a logarithmic axis cuts it off.
void add_point(const Chart& chart, const Series& series, std::size_t i, std::vector<double>& across,
               std::vector<double>& up) {
  across.push_back(series.x[i]);
  up.push_back(series.y[i]);
  if (has_bar(series, i)) {
    up.push_back(series.upper[i]);
    if (chart.y_scale == Scale::kLinear) up.push_back(series.lower[i]);
  }
  if (has_bar_across(series, i)) {
    across.push_back(series.x_upper[i]);
    if (chart.x_scale == Scale::kLinear) across.push_back(series.x_lower[i]);
  }
}

}  // namespace

bool is_shown(const Series& series, std::size_t i) {
  return is_drawable(series.x[i]) && is_drawable(series.y[i]);
}

bool has_bar(const Series& series, std::size_t i) {
  return has_ends(series.lower, series.upper, i);
}

bool has_bar_across(const Series& series, std::size_t i) {
  return has_ends(series.x_lower, series.x_upper, i);
}

int palette_index(const Series& series) { return std::clamp(series.colour, 0, kPaletteSize - 1); }

PlotFrame frame_of(const Chart& chart) {
  std::vector<double> across = chart.x_includes;
  std::vector<double> up = chart.y_includes;
  for (const Series& series : chart.series) {
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (is_shown(series, i)) add_point(chart, series, i, across, up);
    }
  }
  for (const Rule& rule : chart.rules) up.push_back(rule.value);
  PlotFrame frame{
      .x = chart.x_scale == Scale::kLog ? log_axis(across, chart.least_x) : tight_axis(across),
      .y = chart.y_scale == Scale::kLog ? log_axis(up, chart.least_shown)
                                        : rounded_axis(up, kTicksUp)};
  if (chart.x_scale == Scale::kLog && chart.x_has_zero) frame.x.zero_share = kZeroShare;
  if (chart.y_scale == Scale::kLog && chart.y_has_zero) frame.y.zero_share = kZeroShare;
  return frame;
}

}  // namespace qsmpc::harness
