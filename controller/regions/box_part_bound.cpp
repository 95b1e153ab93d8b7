#include "controller/regions/box_part_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

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
