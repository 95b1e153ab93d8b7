// One axis of a chart: its range and its ticks, at numbers that people count in.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

enum class Scale { kLinear, kLog };

struct Axis {
  double lower = 0.0;
  double upper = 1.0;
  Scale scale = Scale::kLinear;
  /// Of a logarithmic axis: the share of its length, at its lower end, that is kept for 0.
  double zero_share = 0.0;
};

struct Tick {
  double value = 0.0;
  std::string label;  ///< empty: of a tick between those that are counted in
};

/// Whether `value` can be placed on a linear axis: finite, and no overflow in sight.
[[nodiscard]] bool is_drawable(double value);

/// A linear axis about the drawable ones of `values`, not rounded, of a length that is not 0;
/// 0 … 1 where there are none.
[[nodiscard]] Axis tight_axis(const std::vector<double>& values);

/// The axis about the same values that ends on ticks.
[[nodiscard]] Axis rounded_axis(const std::vector<double>& values, int tick_count);

/// A logarithmic axis of whole decades about the positive drawable ones of `values`, but with
/// nothing below `least` (> 0), which is taken for 0.
[[nodiscard]] Axis log_axis(const std::vector<double>& values, double least);

/// 1, 2 or 5 times a power of ten, so that about `tick_count` of them fill `span` (> 0).
[[nodiscard]] double tick_step(double span, int tick_count);

/// The multiples of `step` on a linear axis.
[[nodiscard]] std::vector<Tick> ticks_every(const Axis& axis, double step);

/// About `tick_count` ticks; on a logarithmic axis, at powers of ten.
[[nodiscard]] std::vector<Tick> ticks_of(const Axis& axis, int tick_count);

/// The power of ten that is best taken out of the labels of a linear axis and said once: of its
/// largest value where they would have to be written with powers of ten; else 0.
[[nodiscard]] int common_power(const Axis& axis, int tick_count);

/// 2 … 9 times the powers of ten of a logarithmic axis of at most five decades, without labels;
/// none of another axis.
[[nodiscard]] std::vector<Tick> minor_ticks_of(const Axis& axis);

/// Where `value` is on the axis: 0 at its lower end, 1 at its upper one. On a logarithmic axis,
/// what is below the lower end is put there; 0 is put in the middle of its share, if it has one.
[[nodiscard]] double position_on(const Axis& axis, double value);

}  // namespace qsmpc::harness
