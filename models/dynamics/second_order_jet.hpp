// Second-order forward-mode differentiation over intervals: an enclosure of a function's values, of
// its gradient and of its Hessian over a box, carried through every operation by the chain rule.
//
//   using Jet = SecondOrderJet<2>;
//   const Jet x = Jet::variable(Interval(1.0, 2.0), 0);
//   const Jet y = Jet::variable(Interval(-0.1, 0.1), 1);
//   const Jet z = x * sin(y);  // z.hessian(0, 1) encloses cos(y)
//
// The enclosures are those of the arithmetic as written: where a variable occurs several times,
// they are wider than the true ranges, so a model is best written with few occurrences of each.
#pragma once

#include <array>

#include "models/dynamics/interval.hpp"

namespace qsmpc {

/// A function of `kVariables` variables.
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
    return jet;
  }

  [[nodiscard]] const Interval& value() const { return value_; }
  [[nodiscard]] const Interval& gradient(int a) const { return gradient_[a]; }
  [[nodiscard]] const Interval& hessian(int a, int b) const {
    return a < b ? hessian_[entry(b, a)] : hessian_[entry(a, b)];
  }

  friend SecondOrderJet operator-(const SecondOrderJet& f) {
    return map(f, [](const Interval& entry) { return -entry; });
  }
  friend SecondOrderJet operator+(const SecondOrderJet& f, const SecondOrderJet& g) {
    return map(f, g, [](const Interval& s, const Interval& t) { return s + t; });
  }
  friend SecondOrderJet operator-(const SecondOrderJet& f, const SecondOrderJet& g) {
    return map(f, g, [](const Interval& s, const Interval& t) { return s - t; });
  }
  friend SecondOrderJet operator*(double factor, const SecondOrderJet& f) {
    return map(f, [factor](const Interval& entry) { return Interval(factor) * entry; });
  }
  friend SecondOrderJet operator*(const SecondOrderJet& f, double factor) { return factor * f; }
  friend SecondOrderJet operator/(const SecondOrderJet& f, double divisor) {
    const Interval factor = inverse(Interval(divisor));
    return map(f, [factor](const Interval& entry) { return factor * entry; });
  }

  /// (fg)_ab = f g_ab + g f_ab + f_a g_b + f_b g_a.
  friend SecondOrderJet operator*(const SecondOrderJet& f, const SecondOrderJet& g) {
    SecondOrderJet product;
    product.value_ = f.value_ * g.value_;
    for (int a = 0; a < kVariables; ++a) {
      product.gradient_[a] = f.value_ * g.gradient_[a] + g.value_ * f.gradient_[a];
      for (int b = 0; b <= a; ++b) {
        const int ab = entry(a, b);
        product.hessian_[ab] = f.value_ * g.hessian_[ab] + g.value_ * f.hessian_[ab] +
                               f.gradient_[a] * g.gradient_[b] + f.gradient_[b] * g.gradient_[a];
      }
    }
    return product;
  }

  friend SecondOrderJet operator/(const SecondOrderJet& f, const SecondOrderJet& g) {
    const Interval reciprocal = inverse(g.value_);
    const Interval squared = square(reciprocal);
    return f * compose(g, reciprocal, -squared, Interval(2.0) * (squared * reciprocal));
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
  friend SecondOrderJet sqrt(const SecondOrderJet& f) {
    const Interval root = sqrt(f.value_);
    const Interval slope = Interval(0.5) * inverse(root);
    return compose(f, root, slope, -(slope * Interval(0.5) * inverse(f.value_)));
  }

 private:
  static constexpr int kEntries = kVariables * (kVariables + 1) / 2;

  /// Index of the entry (a, b) of the Hessian's lower triangle, a ≥ b.
  static constexpr int entry(int a, int b) { return a * (a + 1) / 2 + b; }

  template <class Function>
  static SecondOrderJet map(const SecondOrderJet& f, Function function) {
    SecondOrderJet result;
    result.value_ = function(f.value_);
    for (int a = 0; a < kVariables; ++a) result.gradient_[a] = function(f.gradient_[a]);
    for (int ab = 0; ab < kEntries; ++ab) result.hessian_[ab] = function(f.hessian_[ab]);
    return result;
  }

  template <class Function>
  static SecondOrderJet map(const SecondOrderJet& f, const SecondOrderJet& g, Function function) {
    SecondOrderJet result;
    result.value_ = function(f.value_, g.value_);
    for (int a = 0; a < kVariables; ++a) {
      result.gradient_[a] = function(f.gradient_[a], g.gradient_[a]);
    }
    for (int ab = 0; ab < kEntries; ++ab) {
      result.hessian_[ab] = function(f.hessian_[ab], g.hessian_[ab]);
    }
    return result;
  }

  /// h(f) from enclosures of h, h' and h'' over the values of f: (h∘f)_ab = h' f_ab + h'' f_a f_b.
  static SecondOrderJet compose(const SecondOrderJet& f, const Interval& value,
                                const Interval& slope, const Interval& curvature) {
    SecondOrderJet result;
    result.value_ = value;
    for (int a = 0; a < kVariables; ++a) {
      result.gradient_[a] = slope * f.gradient_[a];
      for (int b = 0; b <= a; ++b) {
        const Interval outer = a == b ? square(f.gradient_[a]) : f.gradient_[a] * f.gradient_[b];
        result.hessian_[entry(a, b)] = slope * f.hessian_[entry(a, b)] + curvature * outer;
      }
    }
    return result;
  }

  Interval value_;
  std::array<Interval, kVariables> gradient_{};
  std::array<Interval, kEntries> hessian_{};
};

}  // namespace qsmpc
