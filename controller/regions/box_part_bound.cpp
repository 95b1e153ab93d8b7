#include "controller/regions/box_part_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/LU>

#include "controller/measure/normal/bivariate_normal.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "controller/regions/soft_part.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {
// ½ · max over sets A of ∫_A ∂²p for a standard normal density p: a quarter of E|Z² − 1|, which is
// 4φ(1); rounded up.
constexpr double kCurvature = 0.24198;
// Octaves over which t is searched, starting at the error's root mean square; every t gives a
// bound.
constexpr int kPartOctaves = 24;
// Refinements of the search: steps per octave about the best t, then about the best of those, which
// gives 1 % in t.
constexpr int kFineSteps = 8;
constexpr int kFinestSteps = 56;
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
// Determinant of n's covariance relative to the product of the variances: below this, rounding
// dominates.
constexpr double kLeastDeterminant = 1e-12;

/// Mean square of the density of n at the distance to `edge`, E φ_s(edge − y)², with
/// y ~ N(mean, rest): the square of a normal density is one of half the variance.
double mean_square_density(double edge, double mean, double smooth, double rest) {
  if (std::isinf(edge)) return 0.0;
  const double variance = rest + 0.5 * smooth;
  const double height = 0.5 * std::numbers::inv_sqrtpi / std::sqrt(smooth);
  return height * normal_density((edge - mean) / std::sqrt(variance)) / std::sqrt(variance);
}

/// P(z ∈ slab of the box in `axis`).
double slab_probability(const Gaussian& law, const Box& box, Eigen::Index axis) {
  const double mean = law.mean[axis];
  const double lower = box.lower[axis];
  const double upper = box.upper[axis];
  const double deviation = std::sqrt(std::max(0.0, law.covariance(axis, axis)));
  if (deviation > 0.0) {
    return normal_probability((lower - mean) / deviation, (upper - mean) / deviation);
  }
  return mean >= lower && mean <= upper ? 1.0 : 0.0;
}

/// C4 on one coordinate: the slab of the part.
double smooth_slab(const PerturbedGaussian& state, const BoxPart& part, Eigen::Index axis) {
  const double mean = state.law.mean[axis];
  const double variance = state.law.covariance(axis, axis);
  const double lower = part.box.lower[axis];
  const double upper = part.box.upper[axis];
  const double error = state.error[axis];
  if (!std::isfinite(error) || !std::isfinite(mean)) return 1.0;
  const double inside = slab_probability(state.law, part.box, axis);
  if (error == 0.0) return inside;
  const double smooth = state.smoothing(axis, axis);
  if (!(smooth > 0.0)) return 1.0;
  const double rest = std::max(0.0, variance - smooth);
  const double slope = std::sqrt(mean_square_density(lower, mean, smooth, rest) +
                                 mean_square_density(upper, mean, smooth, rest));
  // With a single wall, the second derivative is that of one Φ: half of what two walls can reach.
  const double curvature = std::isinf(lower) || std::isinf(upper) ? 0.5 * kCurvature : kCurvature;
  return inside + error * slope + curvature * error * error / smooth;
}

/// E (∂_a h)² for the rectangle of axes a (first) and b (second): at each edge the density of n_a,
/// squared, times the probability of lying alongside it, which is at most 1 and therefore need not
/// be squared. n_b given n_a is βn_a + ν, so (y_a + n', y_b + βn' + ν) with n' of half the variance
/// of n_a is Gaussian and only has to be evaluated at the edge.
double mean_square_slope(const Eigen::Vector2d& mean, const Eigen::Matrix2d& rest,
                         const Eigen::Matrix2d& smooth, const Eigen::Vector2d& lower,
                         const Eigen::Vector2d& upper, int a) {
  const int b = 1 - a;
  const double beta = smooth(0, 1) / smooth(a, a);
  const double variance = rest(a, a) + 0.5 * smooth(a, a);
  const double cross = rest(0, 1) + 0.5 * beta * smooth(a, a);
  const double other = rest(b, b) + smooth(b, b) - 0.5 * beta * beta * smooth(a, a);
  const double deviation = std::sqrt(std::max(0.0, other - cross * cross / variance));
  double sum = 0.0;
  for (const double edge : {lower[a], upper[a]}) {
    if (std::isinf(edge)) continue;
    const double centre = mean[b] + cross / variance * (edge - mean[a]);
    const double beside = deviation > 0.0 ? normal_probability((lower[b] - centre) / deviation,
                                                               (upper[b] - centre) / deviation)
                                          : 1.0;
    sum += beside * mean_square_density(edge, mean[a], smooth(a, a), rest(a, a));
  }
  return sum;
}

/// C4 on two coordinates: the part's rectangle.
double smooth_rectangle(const PerturbedGaussian& state, const BoxPart& part, Eigen::Index first,
                        Eigen::Index second) {
  const std::vector<Eigen::Index> pair = {first, second};
  const Eigen::Vector2d mean = state.law.mean(pair);
  const Eigen::Matrix2d covariance = state.law.covariance(pair, pair);
  const Eigen::Vector2d lower = part.box.lower(pair);
  const Eigen::Vector2d upper = part.box.upper(pair);
  const Eigen::Vector2d error = state.error(pair);
  if (!error.allFinite() || !mean.allFinite() || !covariance.allFinite()) return 1.0;
  const double inside =
      rectangle_probability(mean, covariance, lower, upper) + rectangle_error(covariance);
  if (error.isZero(0.0)) return inside;
  const Eigen::Matrix2d smooth = state.smoothing(pair, pair);
  // Rounding of the two covariances can make this slightly negative; only the diagonal matters.
  Eigen::Matrix2d rest = covariance - smooth;
  rest.diagonal() = rest.diagonal().cwiseMax(0.0);
  double bound = inside;
  const double product = smooth(0, 0) * smooth(1, 1);
  const double determinant = product - smooth(0, 1) * smooth(0, 1);
  const bool regular = determinant > kLeastDeterminant * product;
  for (int a = 0; a < 2; ++a) {
    if (error[a] == 0.0) continue;
    if (!(smooth(a, a) > 0.0)) return 1.0;
    bound += error[a] * std::sqrt(mean_square_slope(mean, rest, smooth, lower, upper, a));
  }
  if (error[0] > 0.0 && error[1] > 0.0) {
    if (!regular) return 1.0;
    const double form = smooth(1, 1) * error[0] * error[0] + smooth(0, 0) * error[1] * error[1] +
                        2.0 * std::abs(smooth(0, 1)) * error[0] * error[1];
    return bound + kCurvature * form / determinant;
  }
  // Error along one axis only: the relevant spread is that of n along it given n's other
  // coordinate, which decides whether n lies alongside the edge.
  const int moved = error[0] > 0.0 ? 0 : 1;
  const double other = smooth(1 - moved, 1 - moved);
  if (other > 0.0 && !regular) return 1.0;
  const double spread = other > 0.0 ? determinant / other : smooth(moved, moved);
  return bound + kCurvature * error[moved] * error[moved] / spread;
}

/// A part of the unsafe set whose faces are moved outwards by τ norms.
class WidenedPart {
 public:
  WidenedPart(const Gaussian& law, const Eigen::VectorXd& norms, const BoxPart& part)
      : law_(law), norms_(norms), axes_(part.axes), part_(part.box), box_(part.box) {}

  /// Bound of the probability that e exceeds the widening, |axes| τ^−p.
  [[nodiscard]] double tails(double ratio, int order) const {
    double power = 1.0;
    for (int k = 0; k < order; ++k) power *= ratio;
    return static_cast<double>(axes_.size()) / power;
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

/// Search for a t that nearly minimises square/t² + E(1 − d(z, part)²/t²)₊.
class ReachSearch {
 public:
  ReachSearch(const SoftPart& part, double square) : part_(part), square_(square) {}

  /// Empty if no value can be below `useful` (at most 1).
  [[nodiscard]] std::optional<double> best(double useful) {
    // Below this t the first term alone exceeds `useful`; the second term grows with t.
    const double least = 1.02 * std::sqrt(square_ / useful);
    constexpr int kCount = kSoftReaches;
    for (int octave = 0; octave < kPartOctaves; octave += kCount) {
      const Expectations near = try_about(std::ldexp(least, octave), 1.0, 0.0);
      if (octave == 0 && near.front() >= useful) return std::nullopt;
      if (near.back() >= least_value_) break;
    }
    const double coarse = best_;
    try_about(coarse, 1.0 / kFineSteps, kCount);
    try_about(coarse, 1.0 / kFineSteps, -1.0);
    try_about(best_, 1.0 / kFinestSteps, 0.5 * (kCount - 1));
    return best_;
  }

 private:
  using Expectations = std::array<double, kSoftReaches>;

  /// Tries centre · 2^{step (k − before)}, k = 0, 1, …; returns their expectations.
  Expectations try_about(double centre, double step, double before) {
    std::array<double, kSoftReaches> reaches;
    Expectations near;
    const double ratio = std::exp2(step);
    reaches[0] = centre * std::exp2(-step * before);
    for (std::size_t k = 1; k < kSoftReaches; ++k) reaches[k] = reaches[k - 1] * ratio;
    soft_part_by_reach(part_, reaches.data(), near.data());
    for (std::size_t k = 0; k < kSoftReaches; ++k) {
      const double value = square_ / (reaches[k] * reaches[k]) + near[k];
      if (value >= least_value_) continue;
      least_value_ = value;
      best_ = reaches[k];
    }
    return near;
  }

  const SoftPart& part_;
  double square_;
  double best_ = 1.02 * std::sqrt(square_);
  double least_value_ = kInfinity;
};

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

double markov_region_bound(const PerturbedGaussian& state, const BoxPart& part, double useful) {
  double square = 0.0;
  for (const Eigen::Index axis : part.axes) square += state.error[axis] * state.error[axis];
  if (!std::isfinite(square) || !state.law.mean.allFinite() || !state.law.covariance.allFinite()) {
    return 1.0;
  }
  const SoftPart soft = soft_part(state.law.mean, state.law.covariance, part.box);
  // The search uses the vector loops; its result is evaluated again with smaller allowances.
  const std::optional<double> t =
      square == 0.0 ? kSmallestReach : ReachSearch(soft, square).best(useful);
  if (!t) return 1.0;
  return std::min(1.0, square / (*t * *t) + soft_part_probability(soft, *t));
}

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

double smooth_region_bound(const PerturbedGaussian& state, const BoxPart& part) {
  double best = 1.0;
  for (std::size_t i = 0; i < part.axes.size(); ++i) {
    best = std::min(best, smooth_slab(state, part, part.axes[i]));
    for (std::size_t j = 0; j < i; ++j) {
      best = std::min(best, smooth_rectangle(state, part, part.axes[j], part.axes[i]));
    }
  }
  return best;
}

}  // namespace qsmpc::controller
