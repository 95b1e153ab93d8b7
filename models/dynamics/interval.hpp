// Closed intervals of real numbers with enclosing arithmetic: the result of an operation contains
// every value that the operation takes on its operands.
//
//   const Interval speed(4.0, 6.0);
//   const Interval share = 1.0 / (speed + 2.0);  // holds [1/8, 1/6]
//
// Ends may be infinite: [-inf, inf] means that nothing is known, and is the result of a division by
// an interval that contains zero. No operation returns NaN. Boost's interval is not used because
// its 0 · [-inf, inf], sines of unbounded intervals and divisions by zero are NaN, errors or
// policy-dependent, and because its directed rounding switches the processor's mode twice per
// operation. Here results are rounded to nearest and then moved outwards by at least one unit in
// the last place, which encloses the rounding of the operation; only underflow is not accounted
// for.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace qsmpc::models {

class Interval {
 public:
  constexpr Interval() = default;
  /// The single number `value`, finite. Implicit, so that constants mix with intervals.
  constexpr Interval(double value) : lower_(value), upper_(value) {}  // NOLINT: implicit
  /// lower ≤ upper; no check, see the arithmetic.
  constexpr Interval(double lower, double upper) : lower_(lower), upper_(upper) {}

  [[nodiscard]] static constexpr Interval everything() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  /// The interval between two computed ends, moved outwards by a relative `roundings` · 2⁻⁵², which
  /// is at least as many units in the last place. An end that is NaN, or that overflowed to the
  /// wrong side, gives no information: the result is then everything.
  [[nodiscard]] static Interval rounded(double lower, double upper, double roundings = 1.0) {
    if (!(lower <= upper)) return everything();
    constexpr double kLargest = std::numeric_limits<double>::max();
    const double unit = roundings * std::numeric_limits<double>::epsilon();
    const double low = std::min(lower, kLargest);
    const double high = std::max(upper, -kLargest);
    return {low - unit * std::abs(low), high + unit * std::abs(high)};
  }

  [[nodiscard]] constexpr double lower() const { return lower_; }
  [[nodiscard]] constexpr double upper() const { return upper_; }
  [[nodiscard]] constexpr bool contains(double value) const {
    return lower_ <= value && value <= upper_;
  }
  [[nodiscard]] constexpr bool is_zero() const { return lower_ == 0.0 && upper_ == 0.0; }

 private:
  double lower_ = 0.0;
  double upper_ = 0.0;
};

inline Interval operator-(const Interval& a) { return {-a.upper(), -a.lower()}; }

inline Interval operator+(const Interval& a, const Interval& b) {
  if (a.is_zero()) return b;
  if (b.is_zero()) return a;
  return Interval::rounded(a.lower() + b.lower(), a.upper() + b.upper());
}

inline Interval operator-(const Interval& a, const Interval& b) { return a + (-b); }

inline Interval operator*(const Interval& a, const Interval& b) {
  // Most derivatives of a step are zero, and zero times an infinite end would be NaN.
  if (a.is_zero() || b.is_zero()) return {};
  // Zero times an infinite end is 0: the one factor is exactly zero, the other only tends to
  // infinity.
  const auto times = [](double s, double t) { return s == 0.0 || t == 0.0 ? 0.0 : s * t; };
  const double low_low = times(a.lower(), b.lower());
  const double low_high = times(a.lower(), b.upper());
  const double high_low = times(a.upper(), b.lower());
  const double high_high = times(a.upper(), b.upper());
  return Interval::rounded(std::min(std::min(low_low, low_high), std::min(high_low, high_high)),
                           std::max(std::max(low_low, low_high), std::max(high_low, high_high)));
}

/// 1/a; everything if a contains zero.
inline Interval inverse(const Interval& a) {
  if (a.contains(0.0)) return Interval::everything();
  return Interval::rounded(1.0 / a.upper(), 1.0 / a.lower());
}

inline Interval operator/(const Interval& a, const Interval& b) { return a * inverse(b); }

/// {a² : a in the interval}; a · a would be too wide around zero.
inline Interval square(const Interval& a) {
  const double low = std::abs(a.lower());
  const double high = std::abs(a.upper());
  const double least = a.contains(0.0) ? 0.0 : std::min(low, high);
  const double largest = std::max(low, high);
  return Interval::rounded(least * least, largest * largest);
}

/// The square root of the non-negative part of the interval; everything if there is none.
inline Interval sqrt(const Interval& a) {
  if (!(a.upper() >= 0.0)) return Interval::everything();
  return Interval::rounded(std::sqrt(std::max(a.lower(), 0.0)), std::sqrt(a.upper()));
}

namespace interval_detail {

/// The mathematical library's sine, cosine and tangent are accurate to less than two units in the
/// last place.
inline constexpr double kLibraryRoundings = 4.0;

/// The integers n for which (n + shift)·π is in the interval (width below 2π) are first … last.
/// Integers that only rounding could put inside count as inside: the slack exceeds the rounding of
/// the computation below, and is so small that a sine is flat up to rounding over it.
struct Multiples {
  double first;
  double last;
};
inline Multiples multiples_of_pi(const Interval& angle, double shift) {
  constexpr double kSlack = 1e-12;
  const double low = angle.lower() / std::numbers::pi - shift;
  const double high = angle.upper() / std::numbers::pi - shift;
  return {std::ceil(low - kSlack * (1.0 + std::abs(low))),
          std::floor(high + kSlack * (1.0 + std::abs(high)))};
}

/// The range of a wave that is 1 at (n + shift)·π for even n, -1 for odd n, monotone between, from
/// its values at the two ends of `angle`.
inline Interval range_of_wave(const Interval& angle, double at_lower, double at_upper,
                              double shift) {
  const auto [first, last] = multiples_of_pi(angle, shift);
  const bool first_is_even = first == 2.0 * std::floor(0.5 * first);
  const bool has_peak = first < last || (first == last && first_is_even);
  const bool has_trough = first < last || (first == last && !first_is_even);
  const Interval ends = Interval::rounded(std::min(at_lower, at_upper),
                                          std::max(at_lower, at_upper), kLibraryRoundings);
  return {has_trough ? -1.0 : std::max(ends.lower(), -1.0),
          has_peak ? 1.0 : std::min(ends.upper(), 1.0)};
}

inline bool covers_a_period(const Interval& angle) {
  return !(angle.upper() - angle.lower() < 2.0 * std::numbers::pi);
}

}  // namespace interval_detail

inline Interval cos(const Interval& angle) {
  if (interval_detail::covers_a_period(angle)) return {-1.0, 1.0};
  return interval_detail::range_of_wave(angle, std::cos(angle.lower()), std::cos(angle.upper()),
                                        0.0);
}

inline Interval sin(const Interval& angle) {
  if (interval_detail::covers_a_period(angle)) return {-1.0, 1.0};
  return interval_detail::range_of_wave(angle, std::sin(angle.lower()), std::sin(angle.upper()),
                                        0.5);
}

/// Everything if the interval contains a pole.
inline Interval tan(const Interval& angle) {
  if (interval_detail::covers_a_period(angle)) return Interval::everything();
  const auto [first, last] = interval_detail::multiples_of_pi(angle, 0.5);
  if (first <= last) return Interval::everything();
  return Interval::rounded(std::tan(angle.lower()), std::tan(angle.upper()),
                           interval_detail::kLibraryRoundings);
}

/// Monotone; its values are above 0 even where they underflow.
inline Interval exp(const Interval& a) {
  const Interval range = Interval::rounded(std::exp(a.lower()), std::exp(a.upper()),
                                           interval_detail::kLibraryRoundings);
  return {std::max(range.lower(), 0.0),
          std::max(range.upper(), std::numeric_limits<double>::denorm_min())};
}

/// The logarithm of the positive part of the interval; everything if there is none.
inline Interval log(const Interval& a) {
  if (!(a.upper() > 0.0)) return Interval::everything();
  return Interval::rounded(std::log(std::max(a.lower(), 0.0)), std::log(a.upper()),
                           interval_detail::kLibraryRoundings);
}

inline Interval atan(const Interval& a) {
  return Interval::rounded(std::atan(a.lower()), std::atan(a.upper()),
                           interval_detail::kLibraryRoundings);
}

/// Everything if the interval leaves [-1, 1].
inline Interval asin(const Interval& a) {
  if (!(a.lower() >= -1.0 && a.upper() <= 1.0)) return Interval::everything();
  return Interval::rounded(std::asin(a.lower()), std::asin(a.upper()),
                           interval_detail::kLibraryRoundings);
}
inline Interval acos(const Interval& a) {
  if (!(a.lower() >= -1.0 && a.upper() <= 1.0)) return Interval::everything();
  return Interval::rounded(std::acos(a.upper()), std::acos(a.lower()),
                           interval_detail::kLibraryRoundings);
}

inline Interval sinh(const Interval& a) {
  return Interval::rounded(std::sinh(a.lower()), std::sinh(a.upper()),
                           interval_detail::kLibraryRoundings);
}
inline Interval cosh(const Interval& a) {
  const double low = std::abs(a.lower());
  const double high = std::abs(a.upper());
  const double least = a.contains(0.0) ? 0.0 : std::min(low, high);
  return Interval::rounded(std::cosh(least), std::cosh(std::max(low, high)),
                           interval_detail::kLibraryRoundings);
}
inline Interval tanh(const Interval& a) {
  const Interval range = Interval::rounded(std::tanh(a.lower()), std::tanh(a.upper()),
                                           interval_detail::kLibraryRoundings);
  return {std::max(range.lower(), -1.0), std::min(range.upper(), 1.0)};
}

inline Interval abs(const Interval& a) {
  if (a.lower() >= 0.0) return a;
  if (a.upper() <= 0.0) return -a;
  return {0.0, std::max(-a.lower(), a.upper())};
}
inline Interval min(const Interval& a, const Interval& b) {
  return {std::min(a.lower(), b.lower()), std::min(a.upper(), b.upper())};
}
inline Interval max(const Interval& a, const Interval& b) {
  return {std::max(a.lower(), b.lower()), std::max(a.upper(), b.upper())};
}
/// The smallest interval that contains both.
inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.lower(), b.lower()), std::max(a.upper(), b.upper())};
}
/// The intersection of two intervals that are known to overlap.
inline Interval intersection(const Interval& a, const Interval& b) {
  return {std::max(a.lower(), b.lower()), std::min(a.upper(), b.upper())};
}

/// Whether atan2 is continuous over the box: neither the origin nor the cut, where y = 0 and
/// x ≤ 0, is in it.
inline bool atan2_is_continuous(const Interval& y, const Interval& x) {
  return x.lower() > 0.0 || !y.contains(0.0);
}

/// The full turn if atan2 is not continuous over the box. Otherwise the box is convex and excludes
/// the origin, so that the extreme angles are at its corners.
inline Interval atan2(const Interval& y, const Interval& x) {
  const Interval turn = Interval::rounded(-std::numbers::pi, std::numbers::pi);
  if (!atan2_is_continuous(y, x)) return turn;
  const double corners[] = {std::atan2(y.lower(), x.lower()), std::atan2(y.lower(), x.upper()),
                            std::atan2(y.upper(), x.lower()), std::atan2(y.upper(), x.upper())};
  return Interval::rounded(*std::min_element(corners, corners + 4),
                           *std::max_element(corners, corners + 4),
                           interval_detail::kLibraryRoundings);
}

}  // namespace qsmpc::models
