// The inner loops of the bounds C2 and C3, for the processor's widest vectors.
#pragma once

#include <cstddef>

namespace qsmpc::controller {

/// An interval and the spread of a normal variable, as seen from the variable's mean.
struct SoftInterval {
  double lower = 0.0;      ///< less than or equal to `upper`; either may be infinite
  double upper = 0.0;      ///< the same
  double deviation = 0.0;  ///< ≥ 0
};

/// Bounds from above what `soft_interval_probability` is without its allowances,
///     E(1 − dist(y, [lower, upper])²/t²)₊,  y ~ N(0, deviation²),
/// for every reach t > 0 of `reaches`, which has room for `count` entries, into `out`. Greater than
/// that by at most soft_interval_slack.
void soft_interval_by_reach(const SoftInterval& interval, const double* reaches, std::size_t count,
                            double* out);

/// The same for one t and y ~ N(mean, deviation²), mean of `means`.
void soft_interval_by_mean(const SoftInterval& interval, double t, const double* means,
                           std::size_t count, double* out);

/// About P(low ≤ X ≤ high) for standard normal X = (x, y) of correlation r: to 3 % of it
/// for |r| ≤ 0.8. For searches only; no bound. low ≤ high, either may be infinite; |r| < 1.
struct StandardRectangle {
  double low[2];
  double high[2];
};
[[nodiscard]] double rectangle_estimate(const StandardRectangle& rectangle, double correlation);

/// Φ and φ of the vector loops are within 1e-15 of the truth, and φ is zero beyond 8.3. With ε =
/// 1e-15 the bracket of B(D) (certificates.md, section 3) is therefore off by at most
///     ε (2 D² + 4 |D| s + s² (2 + 2 · 9)) ≤ ε (4 D² + 22 s²),
/// as x φ(x) is off by at most 9 ε; rounding of the bracket itself is less than 3 ε (D² + s²).
inline constexpr double kSoftMomentError = 2.5e-14;
/// The probabilities in which an interval and what is before its two ends lie: six values of Φ.
inline constexpr double kSoftMassError = 8e-15;

}  // namespace qsmpc::controller
