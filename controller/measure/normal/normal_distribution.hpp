// The standard normal distribution, accurate in the tails.
#pragma once

#include <cmath>
#include <numbers>

namespace qsmpc::controller {

/// φ(x) = exp(−x²/2)/√(2π); 0 at ±infinity.
[[nodiscard]] inline double normal_density(double x) {
  constexpr double kScale = 0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2;
  return kScale * std::exp(-0.5 * x * x);
}

/// Φ(x) = P(N(0, 1) ≤ x), with full relative accuracy in the lower tail.
[[nodiscard]] inline double normal_cumulative(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// P(lower ≤ N(0, 1) ≤ upper), computed in the tail in which the interval lies, so that far-out
/// intervals keep their relative accuracy. lower ≤ upper; both may be infinite.
[[nodiscard]] inline double normal_probability(double lower, double upper) {
  return lower > 0.0 ? normal_cumulative(-lower) - normal_cumulative(-upper)
                     : normal_cumulative(upper) - normal_cumulative(lower);
}

/// x·φ(x), continued by its limit 0 at ±infinity.
[[nodiscard]] inline double normal_density_moment(double x) {
  return std::isinf(x) ? 0.0 : x * normal_density(x);
}

}  // namespace qsmpc::controller
