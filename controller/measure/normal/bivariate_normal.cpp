#include "controller/measure/normal/bivariate_normal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/owens_t.hpp>

#include "controller/measure/normal/normal_distribution.hpp"

namespace qsmpc::controller {
namespace {

// Correlations closer to ±1 than this count as ±1: rounding does not let them be distinguished.
constexpr double kDegenerate = 1e-15;
// The error that this can cause. ∂P(X ≤ h, Y ≤ k)/∂r is the density at (h, k), at most
// 1/(2π√(1 − r²)), so that each of the four corners changes by at most acos|r|/(2π); the
// correlation's rounding included.
constexpr double kDegenerateError = 4e-8;
// The four corners' derivatives times the correlation's rounding, and that of Owen's T.
constexpr double kCorrelationRounding = 1e-15;
// Standard deviations beyond which a tail (1e-19) is negligible at this accuracy.
constexpr double kFar = 9.0;

// Owen's T in double precision: its few units in the last place are far below kRectangleError.
using PlainDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// T(h, p/h), p ≠ 0 or h ≠ 0. Where |p| > |h|, by the reflection T(h, a) + T(ah, 1/a) =
/// ½(Q(h) + Q(ah)) − Q(h) Q(ah) for h ≥ 0, a > 0, Q(x) = 1 − Φ(x). Boost reflects as well, but
/// computes Q in extended precision.
double owens_t(double h, double p) {
  const double first = std::abs(h);
  const double second = std::abs(p);
  const bool negative = (h < 0.0) != (p < 0.0);
  double value = 0.0;
  if (second <= first) {
    value = boost::math::owens_t(first, second / first, PlainDouble());
  } else {
    const double beyond_first = normal_cumulative(-first);
    const double beyond_second = normal_cumulative(-second);
    value = 0.5 * (beyond_first + beyond_second) - beyond_first * beyond_second -
            boost::math::owens_t(second, first / second, PlainDouble());
  }
  return negative ? -value : value;
}

/// P(X ≤ h, Y ≤ k) for standard normal X, Y of correlation r, |r| < 1 (Owen 1956): half of
/// Φ(h) + Φ(k), less T(h, (k − rh)/(h√(1 − r²))) and its mirror image, less ½ where the signs of h
/// and k differ.
double quadrant(double h, double k, double r) {
  if (h < -kFar || k < -kFar) return 0.0;
  if (h > kFar) return normal_cumulative(k);
  if (k > kFar) return normal_cumulative(h);
  const double root = std::sqrt((1.0 - r) * (1.0 + r));
  if (h == 0.0 && k == 0.0) return 0.25 + std::asin(r) / (2.0 * std::numbers::pi);
  const auto owen = [&](double first, double second) {
    return owens_t(first, (second - r * first) / root);
  };
  const double opposite = h * k < 0.0 || (h * k == 0.0 && h + k < 0.0) ? 0.5 : 0.0;
  return 0.5 * (normal_cumulative(h) + normal_cumulative(k)) - owen(h, k) - owen(k, h) - opposite;
}

/// Correlation of two coordinates with deviations above zero.
double correlation(const Eigen::Matrix2d& covariance, const Eigen::Vector2d& deviation) {
  return covariance(0, 1) / (deviation[0] * deviation[1]);
}

/// The same for X = Y (r = 1) or X = −Y (r = −1) on intervals of X.
double on_a_line(double sign, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  const double from = std::max(low[0], sign > 0.0 ? low[1] : -high[1]);
  const double to = std::min(high[0], sign > 0.0 ? high[1] : -low[1]);
  return from < to ? normal_probability(from, to) : 0.0;
}

}  // namespace

double rectangle_probability(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                             const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  const Eigen::Vector2d deviation = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (int axis = 0; axis < 2; ++axis) {
    if (deviation[axis] > 0.0) continue;
    // This coordinate is deterministic: if it is outside, so is everything.
    if (mean[axis] < lower[axis] || mean[axis] > upper[axis]) return 0.0;
    const int other = 1 - axis;
    if (!(deviation[other] > 0.0)) {
      return mean[other] < lower[other] || mean[other] > upper[other] ? 0.0 : 1.0;
    }
    return normal_probability((lower[other] - mean[other]) / deviation[other],
                              (upper[other] - mean[other]) / deviation[other]);
  }
  const Eigen::Vector2d low = (lower - mean).cwiseQuotient(deviation);
  const Eigen::Vector2d high = (upper - mean).cwiseQuotient(deviation);
  const double r = correlation(covariance, deviation);
  if (std::abs(r) > 1.0 - kDegenerate) return on_a_line(r, low, high);
  const double probability = quadrant(high[0], high[1], r) - quadrant(low[0], high[1], r) -
                             quadrant(high[0], low[1], r) + quadrant(low[0], low[1], r);
  return std::clamp(probability, 0.0, 1.0);
}

double rectangle_error(const Eigen::Matrix2d& covariance) {
  const Eigen::Vector2d deviation = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  if (!(deviation.minCoeff() > 0.0)) return kRectangleError;
  const double r = correlation(covariance, deviation);
  if (std::abs(r) > 1.0 - kDegenerate) return kDegenerateError;
  return kRectangleError + kCorrelationRounding / std::sqrt((1.0 - r) * (1.0 + r));
}

}  // namespace qsmpc::controller
