// One axis of a chart: its range, and its ticks at round numbers.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

enum class Scale { kLinear, kLog };

struct Axis {
  double lower = 0.0;
  double upper = 1.0;
  Scale scale = Scale::kLinear;
  /// On a logarithmic axis: the share of its length, at the lower end, that is reserved for 0.
  double zero_share = 0.0;
};

struct Tick {
  double value = 0.0;
  std::string label;  ///< empty: a minor tick
};

/// Whether `value` can be placed on a linear axis: finite, and well below overflow.
[[nodiscard]] bool is_drawable(double value);

/// A linear axis around the drawable values, not rounded, of non-zero length; 0 … 1 if there are
/// none.
[[nodiscard]] Axis tight_axis(const std::vector<double>& values);

/// The axis around the same values that ends on ticks.
[[nodiscard]] Axis rounded_axis(const std::vector<double>& values, int tick_count);

/// A logarithmic axis of whole decades around the positive drawable values. Values below `least` (>
/// 0) are treated as 0.
[[nodiscard]] Axis log_axis(const std::vector<double>& values, double least);

/// 1, 2 or 5 times a power of ten, such that about `tick_count` of these steps fill `span` (> 0).
[[nodiscard]] double tick_step(double span, int tick_count);

/// The multiples of `step` on a linear axis.
[[nodiscard]] std::vector<Tick> ticks_every(const Axis& axis, double step);

/// About `tick_count` ticks; on a logarithmic axis, at powers of ten.
[[nodiscard]] std::vector<Tick> ticks_of(const Axis& axis, int tick_count);

/// The exponent of the power of ten to factor out of the labels of a linear axis: that of its
/// largest value if the labels would otherwise need powers of ten; else 0.
[[nodiscard]] int common_power(const Axis& axis, int tick_count);

/// Unlabelled ticks at 2 … 9 times the powers of ten of a logarithmic axis of at most five decades;
/// none for any other axis.
[[nodiscard]] std::vector<Tick> minor_ticks_of(const Axis& axis);

/// Position of `value` on the axis: 0 at the lower end, 1 at the upper end. On a logarithmic axis,
/// values below the lower end are placed at it, and 0 in the middle of its share, if it has one.
[[nodiscard]] double position_on(const Axis& axis, double value);

}  // namespace qsmpc::harness
