#include "harness/figures/error_bars.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace qsmpc::harness {
namespace {

std::string bar_up(const Series& series, std::size_t i, const PlotFrame& frame) {
  const double x = frame.across(series.x[i]);
  return fmt::format("M{0:.1f} {1:.1f}h6m-3 0V{2:.1f}m-3 0h6", x - 3.0, frame.up(series.lower[i]),
                     frame.up(series.upper[i]));
}

/// The left end of a horizontal bar: a stroke, or an arrow if the axis cuts it off; nothing if the
/// bar begins at its point, as it does for a rate of 0.
std::string left_end(const Series& series, std::size_t i, const PlotFrame& frame) {
  const double lower = series.x_lower[i];
  const double x = frame.across(lower);
  const double y = frame.up(series.y[i]);
  if (lower >= series.x[i]) return {};
  if (frame.x.scale == Scale::kLog && lower > 0.0 && lower < frame.x.lower) {
    return fmt::format("M{0:.1f} {1:.1f}l-4 3l4 3", x + 4.0, y - 3.0);
  }
  return fmt::format("M{:.1f} {:.1f}v6", x, y - 3.0);
}

std::string bar_across(const Series& series, std::size_t i, const PlotFrame& frame) {
  return left_end(series, i, frame) +
         fmt::format("M{:.1f} {:.1f}H{:.1f}m0 -3v6", frame.across(series.x_lower[i]),
                     frame.up(series.y[i]), frame.across(series.x_upper[i]));
}

}  // namespace

std::string error_bars(const Series& series, const PlotFrame& frame) {
  std::string data;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (has_bar(series, i) && is_drawable(series.x[i])) data += bar_up(series, i, frame);
    if (has_bar_across(series, i) && is_drawable(series.y[i])) {
      data += bar_across(series, i, frame);
    }
  }
  return data;
}

}  // namespace qsmpc::harness
