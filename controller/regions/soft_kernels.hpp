// SIMD inner loops of bounds C2 and C3, for the processor's widest vectors.
#pragma once

#include <cstddef>

namespace qsmpc::controller {

/// An interval and the spread of a normal variable, as seen from the variable's mean.
struct SoftInterval {
  double lower = 0.0;      ///< ≤ `upper`; either may be infinite
  double upper = 0.0;      ///< ≥ `lower`
  double deviation = 0.0;  ///< ≥ 0
};

/// Writes to out[i] an upper bound of `soft_interval_probability` without its allowances,
///     E(1 − dist(y, [lower, upper])²/t²)₊,  y ~ N(0, deviation²),
/// for the reach t = reaches[i] > 0, i < `count`. The bound exceeds this by at most the allowances
/// that follow from kSoftMomentError and kSoftMassError.
void soft_interval_by_reach(const SoftInterval& interval, const double* reaches, std::size_t count,
                            double* out);

/// The same for one t and y ~ N(means[i], deviation²).
void soft_interval_by_mean(const SoftInterval& interval, double t, const double* means,
                           std::size_t count, double* out);

/// Estimate of P(low ≤ X ≤ high) for standard normal X = (x, y) with correlation r, within 3 % for
/// |r| ≤ 0.8. For searches only; not a bound. low ≤ high, either may be infinite; |r| < 1.
struct StandardRectangle {
  double low[2];
  double high[2];
};
[[nodiscard]] double rectangle_estimate(const StandardRectangle& rectangle, double correlation);

/// Φ and φ of the vector loops are within 1e-15 of the exact values, and φ is zero beyond 8.3. With
/// ε = 1e-15 the bracket of B(D) (certificates.md, section 3) is therefore off by at most
///     ε (2 D² + 4 |D| s + s² (2 + 2 · 9)) ≤ ε (4 D² + 22 s²),
/// as x φ(x) is off by at most 9 ε; rounding of the bracket itself is less than 3 ε (D² + s²).
inline constexpr double kSoftMomentError = 2.5e-14;
/// Error of the probabilities of an interval and of the stretches before its two ends: six values
/// of Φ.
inline constexpr double kSoftMassError = 8e-15;

}  // namespace qsmpc::controller
