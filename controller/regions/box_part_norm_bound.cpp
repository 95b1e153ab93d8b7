#include "controller/regions/box_part_norm_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "controller/measure/normal/bivariate_normal.hpp"
#include "controller/measure/normal/integer_power.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {
// Search for τ in the bounds by norms of higher order, up to τ = 30, where the tail τ⁻⁴ of order 4
// is about 1e-6: it tries powers of the first ratio, then searches about the best of them by golden
// sections until it knows τ to the second.
constexpr double kLargestTailRatio = 30.0;
constexpr double kTailRatio = 1.4;
constexpr double kTailAccuracy = 1.08;
// Probabilities at or below this count as zero for every certificate.
constexpr double kZeroProbability = 1e-9;
// Above this estimate a part is not far away: its bound deserves a search.
constexpr double kNotFar = 1e-3;

/// A part of the unsafe set whose faces are moved outwards by τ norms.
class WidenedPart {
 public:
  WidenedPart(const Gaussian& law, const Eigen::VectorXd& norms, const BoxPart& part)
      : law_(law), norms_(norms), axes_(part.axes), part_(part.box), box_(part.box) {}

  /// Bound of the probability that e exceeds the widening, |axes| τ^−p.
  [[nodiscard]] double tails(double ratio, int order) const {
    return static_cast<double>(axes_.size()) / integer_power(ratio, order);
  }

  /// An upper bound of P(z ∈ part widened by τ norms): the least over its coordinates and, unless
  /// one of these is already small enough, over its pairs of coordinates.
  double probability(double ratio) {
    widen(ratio);
    const double slab = least_slab();
    if (slab <= kZeroProbability) return slab;
    const double rectangle = least_over_pairs([&](Eigen::Index a, Eigen::Index b) {
      const Eigen::Matrix2d covariance = pair_covariance(a, b);
      const double inside =
          rectangle_probability({law_.mean[a], law_.mean[b]}, covariance,
                                {box_.lower[a], box_.lower[b]}, {box_.upper[a], box_.upper[b]});
      return inside + rectangle_error(covariance);
    });
    return std::min(slab, rectangle);
  }

  /// An estimate of the same, for searches; a pair's rectangle never has more probability than its
  /// slabs.
  double estimate(double ratio) {
    widen(ratio);
    if (axes_.size() == 1) return least_slab();
    return least_over_pairs([&](Eigen::Index a, Eigen::Index b) {
      const double first = std::sqrt(law_.covariance(a, a));
      const double second = std::sqrt(law_.covariance(b, b));
      const double correlation = law_.covariance(a, b) / (first * second);
      if (!(std::abs(correlation) < 1.0)) return least_slab();
      return rectangle_estimate(
          {.low = {(box_.lower[a] - law_.mean[a]) / first, (box_.lower[b] - law_.mean[b]) / second},
           .high = {(box_.upper[a] - law_.mean[a]) / first,
                    (box_.upper[b] - law_.mean[b]) / second}},
          correlation);
    });
  }

 private:
  void widen(double ratio) {
    for (const Eigen::Index axis : axes_) {
      box_.lower[axis] = part_.lower[axis] - ratio * norms_[axis];
      box_.upper[axis] = part_.upper[axis] + ratio * norms_[axis];
    }
  }

  [[nodiscard]] double least_slab() const {
    double least = 1.0;
    for (const Eigen::Index axis : axes_) {
      least = std::min(least, slab_probability(law_, box_, axis));
    }
    return least;
  }

  template <class Rectangle>
  [[nodiscard]] double least_over_pairs(const Rectangle& rectangle) const {
    double least = 1.0;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) least = std::min(least, rectangle(axes_[j], axes_[i]));
    }
    return least;
  }

  [[nodiscard]] Eigen::Matrix2d pair_covariance(Eigen::Index a, Eigen::Index b) const {
    Eigen::Matrix2d covariance;
    covariance << law_.covariance(a, a), law_.covariance(a, b), law_.covariance(b, a),
        law_.covariance(b, b);
    return covariance;
  }

  const Gaussian& law_;
  const Eigen::VectorXd& norms_;
  const std::vector<Eigen::Index>& axes_;
  const Box& part_;
  Box box_;  ///< widened
};

bool usable(const Gaussian& law, const Eigen::VectorXd& norms, const BoxPart& part) {
  const bool known = std::all_of(part.axes.begin(), part.axes.end(),
                                 [&](Eigen::Index axis) { return std::isfinite(norms[axis]); });
  return known && !part.axes.empty() && law.mean.allFinite() && law.covariance.allFinite();
}

/// Search for a τ that nearly minimises tails(τ) + estimate(τ), the first of which falls and the
/// second grows; their sum may have several minima.
class TailSearch {
 public:
  TailSearch(WidenedPart& widened, int order) : widened_(widened), order_(order) {}

  /// useless: a τ at or below which the minimum is not.
  double best(double useless) {
    double tau = 1.0;
    while (tau <= useless) tau *= kTailRatio;
    // Where the second term alone exceeds the least value, so it does for every larger τ.
    while (tau <= kLargestTailRatio && try_ratio(tau).second < least_) tau *= kTailRatio;
    golden_section(best_ / kTailRatio, best_ * kTailRatio);
    return best_;
  }

 private:
  struct Terms {
    double first;
    double second;
  };

  Terms try_ratio(double tau) {
    const Terms terms{.first = widened_.tails(tau, order_), .second = widened_.estimate(tau)};
    if (terms.first + terms.second < least_) {
      least_ = terms.first + terms.second;
      best_ = tau;
    }
    return terms;
  }

  double value(double logarithm) {
    const Terms terms = try_ratio(std::exp(logarithm));
    return terms.first + terms.second;
  }

  /// In the logarithm.
  void golden_section(double first, double last) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double low = std::log(first);
    double high = std::log(last);
    double inner = high - golden * (high - low);
    double outer = low + golden * (high - low);
    double at_inner = value(inner);
    double at_outer = value(outer);
    while (high - low > std::log(kTailAccuracy)) {
      if (at_inner < at_outer) {
        high = outer;
        outer = inner;
        at_outer = at_inner;
        inner = high - golden * (high - low);
        at_inner = value(inner);
      } else {
        low = inner;
        inner = outer;
        at_inner = at_outer;
        outer = low + golden * (high - low);
        at_outer = value(outer);
      }
    }
  }

  WidenedPart& widened_;
  int order_;
  double best_ = 1.0;
  double least_ = kInfinity;
};

}  // namespace

double tail_region_bound(const Gaussian& law, const Eigen::VectorXd& norms, int order,
                         const BoxPart& part, double useful) {
  if (!usable(law, norms, part)) return 1.0;
  WidenedPart widened(law, norms, part);
  // Below this τ the tails alone exceed `useful`; the probability grows with τ.
  const double least = std::pow(static_cast<double>(part.axes.size()) / useful, 1.0 / order);
  if (least >= kLargestTailRatio) return 1.0;
  if (useful < 1.0 && widened.estimate(least) >= useful) return 1.0;
  const double ratio = TailSearch(widened, order).best(least);
  return std::min(1.0, widened.tails(ratio, order) + widened.probability(ratio));
}

double far_region_bound(const Gaussian& law, const Eigen::VectorXd& norms, int order,
                        const BoxPart& part, double enough) {
  if (!usable(law, norms, part)) return 1.0;
  const double axes = static_cast<double>(part.axes.size());
  const double ratio = std::pow(2.0 * axes / enough, 1.0 / order);
  WidenedPart widened(law, norms, part);
  if (widened.estimate(ratio) > kNotFar) return 1.0;
  return std::min(1.0, widened.tails(ratio, order) + widened.probability(ratio));
}

}  // namespace qsmpc::controller
