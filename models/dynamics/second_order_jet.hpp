// Second-order forward-mode differentiation over intervals: enclosures of a function's values,
// gradient and Hessian over a box, propagated through every operation by the chain rule.
//
//   using Jet = SecondOrderJet<2>;
//   const Jet x = Jet::variable(Interval(1.0, 2.0), 0);
//   const Jet y = Jet::variable(Interval(-0.1, 0.1), 1);
//   const Jet z = x * sin(y);  // z.hessian(0, 1) encloses cos(y)
//
// The enclosures are those of the arithmetic as written: where a variable occurs several times,
// they are wider than the true ranges, so write a model with few occurrences of each variable.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "models/dynamics/interval.hpp"

namespace qsmpc::models {

/// A function of `kVariables` variables. Most parts of a model depend on two or three of them: each
/// jet knows which, and all derivatives by others are zero without being computed.
template <int kVariables>
class SecondOrderJet {
 public:
  SecondOrderJet() = default;
  /// A constant. Implicit, so that constants mix with jets.
  SecondOrderJet(double constant) : value_(constant) {}  // NOLINT: implicit

  [[nodiscard]] static SecondOrderJet variable(const Interval& range, int index) {
    SecondOrderJet jet;
    jet.value_ = range;
    jet.gradient_[index] = 1.0;
    jet.variables_ = VariableSet{1} << index;
    return jet;
  }

  [[nodiscard]] const Interval& value() const { return value_; }
  [[nodiscard]] const Interval& gradient(int a) const { return gradient_[a]; }
  [[nodiscard]] const Interval& hessian(int a, int b) const {
    return a < b ? hessian_[entry(b, a)] : hessian_[entry(a, b)];
  }

  friend SecondOrderJet operator-(const SecondOrderJet& f) {
    return map(f, [](const Interval& part) { return -part; });
  }
  friend SecondOrderJet operator+(const SecondOrderJet& f, const SecondOrderJet& g) {
    return map(f, g, [](const Interval& s, const Interval& t) { return s + t; });
  }
  friend SecondOrderJet operator-(const SecondOrderJet& f, const SecondOrderJet& g) {
    return map(f, g, [](const Interval& s, const Interval& t) { return s - t; });
  }
  friend SecondOrderJet operator*(double factor, const SecondOrderJet& f) {
    return map(f, [factor](const Interval& part) { return Interval(factor) * part; });
  }
  friend SecondOrderJet operator*(const SecondOrderJet& f, double factor) { return factor * f; }
  friend SecondOrderJet operator/(const SecondOrderJet& f, double divisor) {
    const Interval factor = inverse(Interval(divisor));
    return map(f, [factor](const Interval& part) { return factor * part; });
  }

  /// (fg)_ab = f g_ab + g f_ab + f_a g_b + f_b g_a.
  friend SecondOrderJet operator*(const SecondOrderJet& f, const SecondOrderJet& g) {
    SecondOrderJet product;
    product.variables_ = f.variables_ | g.variables_;
    product.value_ = f.value_ * g.value_;
    for_each(product.variables_, [&](int a) {
      product.gradient_[a] = f.value_ * g.gradient_[a] + g.value_ * f.gradient_[a];
    });
    for_each_pair(product.variables_, [&](int a, int b, int ab) {
      product.hessian_[ab] = f.value_ * g.hessian_[ab] + g.value_ * f.hessian_[ab] +
                             f.gradient_[a] * g.gradient_[b] + f.gradient_[b] * g.gradient_[a];
    });
    return product;
  }

  friend SecondOrderJet operator/(const SecondOrderJet& f, const SecondOrderJet& g) {
    return f * inverse(g);
  }
  friend SecondOrderJet operator/(double f, const SecondOrderJet& g) { return f * inverse(g); }

  friend SecondOrderJet inverse(const SecondOrderJet& f) {
    const Interval reciprocal = inverse(f.value_);
    const Interval squared = square(reciprocal);
    return compose(f, reciprocal, -squared, Interval(2.0) * (squared * reciprocal));
  }
  friend SecondOrderJet sin(const SecondOrderJet& f) {
    const Interval sine = sin(f.value_);
    return compose(f, sine, cos(f.value_), -sine);
  }
  friend SecondOrderJet cos(const SecondOrderJet& f) {
    const Interval cosine = cos(f.value_);
    return compose(f, cosine, -sin(f.value_), -cosine);
  }
  friend SecondOrderJet tan(const SecondOrderJet& f) {
    const Interval tangent = tan(f.value_);
    const Interval slope = Interval(1.0) + square(tangent);
    return compose(f, tangent, slope, Interval(2.0) * tangent * slope);
  }
  friend SecondOrderJet square(const SecondOrderJet& f) {
    return compose(f, square(f.value_), Interval(2.0) * f.value_, Interval(2.0));
  }
  friend SecondOrderJet exp(const SecondOrderJet& f) {
    const Interval power = exp(f.value_);
    return compose(f, power, power, power);
  }
  friend SecondOrderJet log(const SecondOrderJet& f) {
    const Interval slope = inverse(f.value_);
    return compose(f, log(f.value_), slope, -square(slope));
  }
  friend SecondOrderJet asin(const SecondOrderJet& f) {
    const Interval slope = inverse(sqrt(Interval(1.0) - square(f.value_)));
    return compose(f, asin(f.value_), slope, f.value_ * (slope * square(slope)));
  }
  friend SecondOrderJet acos(const SecondOrderJet& f) {
    const Interval slope = -inverse(sqrt(Interval(1.0) - square(f.value_)));
    return compose(f, acos(f.value_), slope, f.value_ * (slope * square(slope)));
  }
  /// |h''| = |2x/(1 + x²)²| is at most 3√3/8 < 0.65.
  friend SecondOrderJet atan(const SecondOrderJet& f) {
    const Interval slope = inverse(Interval(1.0) + square(f.value_));
    const Interval curvature = -(Interval(2.0) * f.value_ * square(slope));
    return compose(f, atan(f.value_), slope, intersection(curvature, Interval(-0.65, 0.65)));
  }
  friend SecondOrderJet sinh(const SecondOrderJet& f) {
    const Interval sine = sinh(f.value_);
    return compose(f, sine, cosh(f.value_), sine);
  }
  friend SecondOrderJet cosh(const SecondOrderJet& f) {
    const Interval cosine = cosh(f.value_);
    return compose(f, cosine, sinh(f.value_), cosine);
  }
  friend SecondOrderJet tanh(const SecondOrderJet& f) {
    const Interval tangent = tanh(f.value_);
    const Interval slope = Interval(1.0) - square(tangent);
    return compose(f, tangent, slope, Interval(-2.0) * tangent * slope);
  }
  /// At a kink the slope is between those of the two sides, and no second derivative is known.
  friend SecondOrderJet abs(const SecondOrderJet& f) {
    if (f.value_.lower() >= 0.0) return f;
    if (f.value_.upper() <= 0.0) return -f;
    return compose(f, abs(f.value_), Interval(-1.0, 1.0), Interval::everything());
  }
  friend SecondOrderJet min(const SecondOrderJet& f, const SecondOrderJet& g) {
    if (f.value_.upper() <= g.value_.lower()) return f;
    if (g.value_.upper() <= f.value_.lower()) return g;
    return either(f, g, min(f.value_, g.value_));
  }
  friend SecondOrderJet max(const SecondOrderJet& f, const SecondOrderJet& g) {
    if (f.value_.lower() >= g.value_.upper()) return f;
    if (g.value_.lower() >= f.value_.upper()) return g;
    return either(f, g, max(f.value_, g.value_));
  }
  /// With r² = x² + y²: ∂/∂y = x/r², ∂/∂x = −y/r²; nothing is known across the cut and at 0.
  friend SecondOrderJet atan2(const SecondOrderJet& y, const SecondOrderJet& x) {
    const Interval value = atan2(y.value_, x.value_);
    if (!atan2_is_continuous(y.value_, x.value_)) return unknown(y, x, value);
    const Interval by_square = inverse(square(x.value_) + square(y.value_));
    const Interval by_y = x.value_ * by_square;
    const Interval by_x = -(y.value_ * by_square);
    const Interval mixed = square(by_x) - square(by_y);
    const Interval twice = Interval(2.0) * (by_x * by_y);  // ∂²/∂y² = −∂²/∂x²
    SecondOrderJet result;
    result.variables_ = y.variables_ | x.variables_;
    result.value_ = value;
    for_each(result.variables_,
             [&](int a) { result.gradient_[a] = by_y * y.gradient_[a] + by_x * x.gradient_[a]; });
    for_each_pair(result.variables_, [&](int a, int b, int ab) {
      const Interval& ya = y.gradient_[a];
      const Interval& yb = y.gradient_[b];
      const Interval& xa = x.gradient_[a];
      const Interval& xb = x.gradient_[b];
      result.hessian_[ab] = by_y * y.hessian_[ab] + by_x * x.hessian_[ab] +
                            twice * (a == b ? square(ya) - square(xa) : ya * yb - xa * xb) +
                            mixed * (ya * xb + yb * xa);
    });
    return result;
  }
  /// Integer exponents for any base; other exponents for a base above 0.
  friend SecondOrderJet pow(const SecondOrderJet& f, double exponent) {
    constexpr double kMostFactors = 64.0;
    if (exponent < 0.0) return inverse(pow(f, -exponent));
    if (exponent != std::floor(exponent) || exponent > kMostFactors) {
      return exponent == 0.5 ? sqrt(f) : exp(exponent * log(f));
    }
    if (exponent == 0.0) return 1.0;
    if (exponent == 1.0) return f;
    const SecondOrderJet half = square(pow(f, std::floor(0.5 * exponent)));
    return std::fmod(exponent, 2.0) == 0.0 ? half : f * half;
  }
  friend SecondOrderJet pow(const SecondOrderJet& f, int exponent) {
    return pow(f, static_cast<double>(exponent));
  }
  friend SecondOrderJet pow(const SecondOrderJet& f, const SecondOrderJet& exponent) {
    return exp(exponent * log(f));
  }

  SecondOrderJet& operator+=(const SecondOrderJet& other) { return *this = *this + other; }
  SecondOrderJet& operator-=(const SecondOrderJet& other) { return *this = *this - other; }
  SecondOrderJet& operator*=(const SecondOrderJet& other) { return *this = *this * other; }
  SecondOrderJet& operator/=(const SecondOrderJet& other) { return *this = *this / other; }

  friend SecondOrderJet sqrt(const SecondOrderJet& f) {
    const Interval root = sqrt(f.value_);
    const Interval slope = Interval(0.5) * inverse(root);
    return compose(f, root, slope, -(slope * Interval(0.5) * inverse(f.value_)));
  }

 private:
  using VariableSet = std::uint32_t;  ///< bit a: may depend on variable a
  static_assert(kVariables <= std::numeric_limits<VariableSet>::digits);
  static constexpr int kEntries = kVariables * (kVariables + 1) / 2;

  /// Index of the entry (a, b) of the Hessian's lower triangle, a ≥ b.
  static constexpr int entry(int a, int b) { return a * (a + 1) / 2 + b; }

  /// visit(a) for every variable of the set.
  template <class Visit>
  static void for_each(VariableSet set, Visit visit) {
    for (; set != 0; set &= set - 1) visit(std::countr_zero(set));
  }
  /// visit(a, b, entry(a, b)) for every a ≥ b of the set.
  template <class Visit>
  static void for_each_pair(VariableSet set, Visit visit) {
    for_each(set, [&](int a) {
      const VariableSet up_to_a = set & ((VariableSet{2} << a) - 1);
      for_each(up_to_a, [&](int b) { visit(a, b, entry(a, b)); });
    });
  }

  /// Applies a linear function of one or two jets component by component.
  template <class Function>
  static SecondOrderJet map(const SecondOrderJet& f, Function function) {
    SecondOrderJet result;
    result.variables_ = f.variables_;
    result.value_ = function(f.value_);
    for_each(f.variables_, [&](int a) { result.gradient_[a] = function(f.gradient_[a]); });
    for_each_pair(f.variables_,
                  [&](int, int, int ab) { result.hessian_[ab] = function(f.hessian_[ab]); });
    return result;
  }
  template <class Function>
  static SecondOrderJet map(const SecondOrderJet& f, const SecondOrderJet& g, Function function) {
    SecondOrderJet result;
    result.variables_ = f.variables_ | g.variables_;
    result.value_ = function(f.value_, g.value_);
    for_each(result.variables_,
             [&](int a) { result.gradient_[a] = function(f.gradient_[a], g.gradient_[a]); });
    for_each_pair(result.variables_, [&](int, int, int ab) {
      result.hessian_[ab] = function(f.hessian_[ab], g.hessian_[ab]);
    });
    return result;
  }

  /// The result where it may be f or g: a kink, at which no second derivative is known.
  static SecondOrderJet either(const SecondOrderJet& f, const SecondOrderJet& g,
                               const Interval& value) {
    SecondOrderJet result = unknown(f, g, value);
    for_each(result.variables_,
             [&](int a) { result.gradient_[a] = hull(f.gradient_[a], g.gradient_[a]); });
    return result;
  }
  /// A function of f and g of which only the values are known.
  static SecondOrderJet unknown(const SecondOrderJet& f, const SecondOrderJet& g,
                                const Interval& value) {
    SecondOrderJet result;
    result.variables_ = f.variables_ | g.variables_;
    result.value_ = value;
    for_each(result.variables_, [&](int a) { result.gradient_[a] = Interval::everything(); });
    for_each_pair(result.variables_,
                  [&](int, int, int ab) { result.hessian_[ab] = Interval::everything(); });
    return result;
  }

  /// h(f) from enclosures of h, h' and h'' over the values of f: (h∘f)_ab = h' f_ab + h'' f_a f_b.
  static SecondOrderJet compose(const SecondOrderJet& f, const Interval& value,
                                const Interval& slope, const Interval& curvature) {
    SecondOrderJet result;
    result.variables_ = f.variables_;
    result.value_ = value;
    for_each(f.variables_, [&](int a) { result.gradient_[a] = slope * f.gradient_[a]; });
    for_each_pair(f.variables_, [&](int a, int b, int ab) {
      const Interval outer = a == b ? square(f.gradient_[a]) : f.gradient_[a] * f.gradient_[b];
      result.hessian_[ab] = slope * f.hessian_[ab] + curvature * outer;
    });
    return result;
  }

  Interval value_;
  std::array<Interval, kVariables> gradient_{};
  std::array<Interval, kEntries> hessian_{};
  VariableSet variables_ = 0;
};

}  // namespace qsmpc::models
