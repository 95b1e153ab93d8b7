#include "controller/certification/saturation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "controller/measure/normal_distribution.hpp"

namespace qsmpc {
namespace {

// Relative to the terms of a difference: what cancellation between them can leave.
constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// E (Z − z)₊ and E (Z − z)₊² for Z ~ N(0, 1).
struct Excess {
  double first;
  double second;
  double rounding;  ///< bounds the error of `second`
};

Excess excess(double z) {
  const double tail = normal_cumulative(-z);
  const double density = normal_density(z);
  // In the tail the two terms nearly cancel, and z² roundings are in the density of z.
  const double roundings = z > 0.0 ? 1.0 + z * z : 1.0;
  return {.first = std::max(0.0, density - z * tail),
          .second = std::max(0.0, (1.0 + z * z) * tail - z * density),
          .rounding = kRounding * std::max(0.0, roundings * (1.0 + z * z) * tail)};
}

}  // namespace

// With h = (upper − m)/s and l = (m − lower)/s, sat(ℓ) − m = s (Z − (Z − h)₊ + (−Z − l)₊). The two
// excesses o, u never are positive together, so that with p, q the tails beyond h and l
//     E sat = m + s (E u − E o),  slope = E[(Z − o + u) Z] = 1 − p − q,
// and the residual is r = (p + q) Z − o + u − E(u − o), whose variance
//     Var(u − o) − (p + q)²
// vanishes with the excesses themselves: no difference of numbers of order one is taken.
SaturationFit fit_saturation(double mean, double deviation, double lower, double upper) {
  if (!(deviation > 0.0)) {
    const bool inside = mean > lower && mean < upper;
    return {.mean = std::clamp(mean, lower, upper), .slope = inside ? 1.0 : 0.0, .residual = 0.0};
  }
  const double high = (upper - mean) / deviation;
  const double low = (mean - lower) / deviation;
  const Excess over = excess(high);
  const Excess under = excess(low);
  const double outside = normal_cumulative(-high) + normal_cumulative(-low);
  const double shift = under.first - over.first;
  const double squares = over.second + under.second;
  const double variance = squares - shift * shift - outside * outside;
  return {
      .mean = std::clamp(mean + deviation * shift, lower, upper),
      .slope = std::clamp(1.0 - outside, 0.0, 1.0),
      .residual = deviation * std::sqrt(std::max(0.0, variance) + over.rounding + under.rounding)};
}

double largest_saturation_residual(const SaturationFit& fit, double mean, double reach,
                                   double lower, double upper) {
  // Piecewise linear: extreme at the ends or where the clamp bends.
  double largest = 0.0;
  for (const double wanted : {-reach, reach, lower - mean, upper - mean}) {
    const double s = std::clamp(wanted, -reach, reach);
    const double residual = std::clamp(mean + s, lower, upper) - fit.mean - fit.slope * s;
    largest = std::max(largest, std::abs(residual));
  }
  return largest;
}

}  // namespace qsmpc
