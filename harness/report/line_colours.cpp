#include "harness/report/line_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/palette.hpp"
#include "harness/text/number_format.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

/// Speeds by period, m/s; NaN for a period whose end is not known.
std::vector<double> speeds_of(const Trace& trace) {
  const int x = trace.system.position_x;
  const int y = trace.system.position_y;
  const Eigen::MatrixXd states = true_states(trace);
  std::vector<double> speeds;
  for (Eigen::Index k = 0; k + 1 < states.cols(); ++k) {
    const double way = std::hypot(states(x, k + 1) - states(x, k), states(y, k + 1) - states(y, k));
    speeds.push_back(way / trace.scenario.time_step);
  }
  return speeds;
}

/// Minimum and maximum of the finite values.
std::pair<double, double> range_of(const std::vector<double>& values) {
  double least = kInfinity;
  double most = -kInfinity;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return {least, most};
}

}  // namespace

LineColours speed_colours(const Trace& trace) {
  LineColours colours{.title = "Driven line by speed", .names = {}, .classes = {}};
  const std::vector<double> speeds = speeds_of(trace);
  const auto [least, most] = range_of(speeds);
  const double width = std::max(1e-9, (most - least) / kScaleSize);
  for (int n = 0; n < kScaleSize; ++n) {
    colours.names.push_back(fmt::format("{} to {} m/s", format_fixed(least + n * width, 2),
                                        format_fixed(least + (n + 1) * width, 2)));
  }
  for (const double speed : speeds) {
    const bool is_known = std::isfinite(speed);
    const double place = is_known ? (speed - least) / width : -1.0;
    colours.classes.push_back(is_known ? std::min(static_cast<int>(place), kScaleSize - 1) : -1);
  }
  return colours;
}

LineColours risk_colours(const Trace& trace) {
  constexpr std::array<double, kScaleSize - 1> kLimits = {1e-6, 1e-4, 1e-3, 1e-2};
  LineColours colours{.title = "Driven line by certified risk",
                      .note =
                          "Upper bound of the probability of being unsafe at the next control "
                          "instant.",
                      .names = {"up to 10⁻⁶", "up to 10⁻⁴", "up to 10⁻³", "up to 10⁻²", "above"},
                      .classes = {}};
  for (const StepRecord& step : trace.steps) {
    const double risk = step.certificates.empty() ? kNotANumber : step.certificates.front().value;
    const auto limit = std::ranges::find_if(kLimits, [&](double most) { return risk <= most; });
    colours.classes.push_back(std::isnan(risk) ? -1 : static_cast<int>(limit - kLimits.begin()));
  }
  return colours;
}

std::vector<MapPath> coloured_line(const LineColours& colours,
                                   const std::vector<MapPoint>& places) {
  std::vector<MapPath> runs;
  const std::size_t periods =
      std::min(colours.classes.size(), places.empty() ? 0 : places.size() - 1);
  int last = -1;
  for (std::size_t k = 0; k < periods; ++k) {
    const int now = colours.classes[k];
    if (now < 0) {
      last = -1;
      continue;
    }
    if (now != last) {
      runs.push_back({.name = colours.names[static_cast<std::size_t>(now)],
                      .colour = kFirstScale + now,
                      .points = {places[k]}});
    }
    runs.back().points.push_back(places[k + 1]);
    last = now;
  }
  // From low to high in the legend.
  std::ranges::stable_sort(runs, {}, [](const MapPath& run) { return run.colour; });
  return runs;
}

}  // namespace qsmpc::harness
