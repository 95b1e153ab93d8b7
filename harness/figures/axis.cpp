#include "harness/figures/axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/text/number_format.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kLargestDrawable = 1e100;
constexpr double kRounding = 1e-9;     // of a step: tolerance of ticks at the ends of the range
constexpr double kLargestPlain = 1e6;  // larger values and smaller steps are labelled with an
                                       // exponent
constexpr double kSmallestPlainStep = 1e-4;

bool has_span(double lower, double upper) {
  constexpr double kLeastRelativeSpan = 1e-9;  // below it, tick labels would all look the same
  return upper - lower > kLeastRelativeSpan * std::max(std::abs(lower), std::abs(upper));
}

std::string linear_label(double value, double step) {
  if (std::abs(value) < step * kRounding) return "0";
  if (std::abs(value) >= kLargestPlain || step < kSmallestPlainStep) return format_short(value, 3);
  const double decimals = -std::floor(std::log10(step) + kRounding);
  return format_fixed(value, static_cast<int>(std::max(0.0, decimals)));
}

std::vector<Tick> log_ticks(const Axis& axis, int tick_count) {
  const int first = static_cast<int>(std::lround(std::log10(axis.lower)));
  const int last = static_cast<int>(std::lround(std::log10(axis.upper)));
  const int stride = std::max(1, (last - first + tick_count - 1) / tick_count);
  std::vector<Tick> ticks;
  for (int exponent = last; exponent >= first; exponent -= stride) {
    ticks.push_back({std::pow(10.0, exponent), format_power_of_ten(exponent)});
  }
  if (axis.zero_share > 0.0) ticks.push_back({0.0, "0"});
  std::reverse(ticks.begin(), ticks.end());
  return ticks;
}

}  // namespace

bool is_drawable(double value) {
  return std::isfinite(value) && std::abs(value) < kLargestDrawable;
}

Axis tight_axis(const std::vector<double>& values) {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -lower;
  for (const double value : values) {
    if (!is_drawable(value)) continue;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  if (lower > upper) return {};
  if (!has_span(lower, upper)) {
    constexpr double kRelativeMargin = 0.1;
    const double margin = lower == 0.0 && upper == 0.0
                              ? 0.5
                              : kRelativeMargin * std::max(std::abs(lower), std::abs(upper));
    return {.lower = lower - margin, .upper = upper + margin};
  }
  return {.lower = lower, .upper = upper};
}

Axis rounded_axis(const std::vector<double>& values, int tick_count) {
  const Axis tight = tight_axis(values);
  const double step = tick_step(tight.upper - tight.lower, tick_count);
  return {.lower = std::floor(tight.lower / step + kRounding) * step,
          .upper = std::ceil(tight.upper / step - kRounding) * step};
}

Axis log_axis(const std::vector<double>& values, double least) {
  double lower = std::numeric_limits<double>::infinity();
  double upper = least;
  for (const double value : values) {
    if (!is_drawable(value) || value <= 0.0) continue;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  lower = std::clamp(lower, least, upper);
  const double first = std::floor(std::log10(lower) + kRounding);
  const double last = std::max(first + 1.0, std::ceil(std::log10(upper) - kRounding));
  return {.lower = std::pow(10.0, first), .upper = std::pow(10.0, last), .scale = Scale::kLog};
}

double tick_step(double span, int tick_count) {
  const double raw = span / tick_count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double digit = raw / power;
  if (digit <= 1.0 + kRounding) return power;
  if (digit <= 2.0 + kRounding) return 2.0 * power;
  return digit <= 5.0 + kRounding ? 5.0 * power : 10.0 * power;
}

std::vector<Tick> ticks_every(const Axis& axis, double step) {
  const double first = std::ceil(axis.lower / step - kRounding);
  const double last = std::floor(axis.upper / step + kRounding);
  const int count = static_cast<int>(last - first) + 1;
  std::vector<Tick> ticks;
  for (int i = 0; i < count; ++i) {
    const double value = (first + i) * step;
    ticks.push_back({value, linear_label(value, step)});
  }
  return ticks;
}

std::vector<Tick> ticks_of(const Axis& axis, int tick_count) {
  if (axis.scale == Scale::kLog) return log_ticks(axis, tick_count);
  return ticks_every(axis, tick_step(axis.upper - axis.lower, tick_count));
}

int common_power(const Axis& axis, int tick_count) {
  if (axis.scale == Scale::kLog) return 0;
  const double largest = std::max(std::abs(axis.lower), std::abs(axis.upper));
  const double step = tick_step(axis.upper - axis.lower, tick_count);
  if (largest < kLargestPlain && step >= kSmallestPlainStep) return 0;
  return static_cast<int>(std::floor(std::log10(largest) + kRounding));
}

std::vector<Tick> minor_ticks_of(const Axis& axis) {
  constexpr int kMostDecades = 5;  // with more, the ticks would run together
  if (axis.scale != Scale::kLog) return {};
  const int first = static_cast<int>(std::lround(std::log10(axis.lower)));
  const int last = static_cast<int>(std::lround(std::log10(axis.upper)));
  if (last - first > kMostDecades) return {};
  std::vector<Tick> ticks;
  for (int exponent = first; exponent < last; ++exponent) {
    for (int digit = 2; digit <= 9; ++digit) {
      ticks.push_back({.value = digit * std::pow(10.0, exponent), .label = ""});
    }
  }
  return ticks;
}

double position_on(const Axis& axis, double value) {
  if (axis.scale == Scale::kLinear) return (value - axis.lower) / (axis.upper - axis.lower);
  if (value <= 0.0 && axis.zero_share > 0.0) return 0.5 * axis.zero_share;
  const double clamped = std::max(value, axis.lower);
  const double along = std::log(clamped / axis.lower) / std::log(axis.upper / axis.lower);
  return axis.zero_share + (1.0 - axis.zero_share) * along;
}

}  // namespace qsmpc::harness
