#include "controller/certification/part_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "controller/certification/smoothed_bound.hpp"
#include "controller/measure/bivariate_normal.hpp"
#include "controller/measure/normal_distribution.hpp"

namespace qsmpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// ½ · max over sets A of ∫_A ∂²p for a standard normal density p: a quarter of E|Z² − 1|, which is
// 4φ(1); rounded up.
constexpr double kCurvature = 0.24198;
// Golden-section steps over seven decades of t: to within 2 %, and every t gives a bound.
constexpr int kSearchSteps = 18;
constexpr double kLargestRatio = 1e7;
// The same for τ of the norms of higher order; beyond 30, no less than 1e-6 is left.
constexpr double kLargestTailRatio = 30.0;
constexpr int kTailSteps = 7;
// A probability that no certificate needs to be told from zero.
constexpr double kNegligible = 1e-9;
// Of n's covariance, relative to the product of the variances: below it rounding decides.
constexpr double kLeastDeterminant = 1e-12;

/// Mean square of the density of n at the distance to `edge`, E φ_s(edge − y)², with
/// y ~ N(mean, rest): the square of a normal density is one of half the variance.
double mean_square_density(double edge, double mean, double smooth, double rest) {
  if (std::isinf(edge)) return 0.0;
  const double variance = rest + 0.5 * smooth;
  const double height = 0.5 * std::numbers::inv_sqrtpi / std::sqrt(smooth);
  return height * normal_density((edge - mean) / std::sqrt(variance)) / std::sqrt(variance);
}

/// P(z ∈ slab of the part in `axis`).
double slab_probability(const Gaussian& law, const UnsafePart& part, Eigen::Index axis) {
  const double mean = law.mean[axis];
  const double lower = part.box.lower[axis];
  const double upper = part.box.upper[axis];
  const double deviation = std::sqrt(std::max(0.0, law.covariance(axis, axis)));
  if (deviation > 0.0) {
    return normal_probability((lower - mean) / deviation, (upper - mean) / deviation);
  }
  return mean >= lower && mean <= upper ? 1.0 : 0.0;
}

/// C4 on one coordinate: the slab of the part.
double smooth_slab(const PerturbedGaussian& state, const UnsafePart& part, Eigen::Index axis) {
  const double mean = state.law.mean[axis];
  const double variance = state.law.covariance(axis, axis);
  const double lower = part.box.lower[axis];
  const double upper = part.box.upper[axis];
  const double error = state.error[axis];
  if (!std::isfinite(error) || !std::isfinite(mean)) return 1.0;
  const double inside = slab_probability(state.law, part, axis);
  if (error == 0.0) return inside;
  const double smooth = state.smoothing(axis, axis);
  if (!(smooth > 0.0)) return 1.0;
  const double rest = std::max(0.0, variance - smooth);
  const double slope = std::sqrt(mean_square_density(lower, mean, smooth, rest) +
                                 mean_square_density(upper, mean, smooth, rest));
  // One wall: the second derivative is that of Φ alone, half of what two can reach together.
  const double curvature = std::isinf(lower) || std::isinf(upper) ? 0.5 * kCurvature : kCurvature;
  return inside + error * slope + curvature * error * error / smooth;
}

/// E (∂_a h)² for the rectangle of axes a (first) and b (second): at each edge the density of n_a,
/// squared, with the probability of being beside it, which is at most 1 and so serves unsquared.
/// n_b given n_a is βn_a + ν, so (y_a + n', y_b + βn' + ν) with n' of half the variance of n_a is
/// Gaussian and only has to be taken at the edge.
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
double smooth_rectangle(const PerturbedGaussian& state, const UnsafePart& part, Eigen::Index first,
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
  // Rounding of the two covariances can leave this a hair below zero; the diagonal is what counts.
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
  // Along one axis only: what counts is how n spreads there once its other coordinate is known,
  // which decides whether it is beside.
  const int moved = error[0] > 0.0 ? 0 : 1;
  const double other = smooth(1 - moved, 1 - moved);
  if (other > 0.0 && !regular) return 1.0;
  const double spread = other > 0.0 ? determinant / other : smooth(moved, moved);
  return bound + kCurvature * error[moved] * error[moved] / spread;
}

/// At least P(z ∈ part): the least over its coordinates and, unless one of these is small enough
/// by itself, its pairs of coordinates.
double probability_of_part(const Gaussian& law, const UnsafePart& part) {
  double least = 1.0;
  for (const Eigen::Index axis : part.axes) {
    least = std::min(least, slab_probability(law, part, axis));
  }
  for (std::size_t i = 0; i < part.axes.size() && least > kNegligible; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::vector<Eigen::Index> pair = {part.axes[j], part.axes[i]};
      const Eigen::Matrix2d covariance = law.covariance(pair, pair);
      const double inside = rectangle_probability(law.mean(pair), covariance, part.box.lower(pair),
                                                  part.box.upper(pair));
      least = std::min(least, inside + rectangle_error(covariance));
    }
  }
  return least;
}

bool usable(const Gaussian& law, const Eigen::VectorXd& norms, const UnsafePart& part) {
  const bool known = std::all_of(part.axes.begin(), part.axes.end(),
                                 [&](Eigen::Index axis) { return std::isfinite(norms[axis]); });
  return known && law.mean.allFinite() && law.covariance.allFinite();
}

/// |axes| τ^−p + P(z ∈ part widened by τ · norms).
double widened_bound(const Gaussian& law, const Eigen::VectorXd& norms, int order,
                     const UnsafePart& part, double ratio) {
  UnsafePart wide = part;
  for (const Eigen::Index axis : part.axes) {
    wide.box.lower[axis] -= ratio * norms[axis];
    wide.box.upper[axis] += ratio * norms[axis];
  }
  return static_cast<double>(part.axes.size()) * std::pow(ratio, -order) +
         probability_of_part(law, wide);
}

/// The least of `value` found by golden sections over [first, first · ratio], in the logarithm. One
/// valley is expected; where there are more, what is found is a value as well.
template <class Value>
double least_on_logarithmic_scale(const Value& value, double first, double ratio, int steps) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = std::log(first);
  double high = low + std::log(ratio);
  double inner = high - golden * (high - low);
  double outer = low + golden * (high - low);
  double at_inner = value(std::exp(inner));
  double at_outer = value(std::exp(outer));
  double best = std::min({1.0, at_inner, at_outer});
  for (int step = 0; step < steps; ++step) {
    if (at_inner < at_outer) {
      high = outer;
      outer = inner;
      at_outer = at_inner;
      inner = high - golden * (high - low);
      at_inner = value(std::exp(inner));
    } else {
      low = inner;
      inner = outer;
      at_inner = at_outer;
      outer = low + golden * (high - low);
      at_outer = value(std::exp(outer));
    }
    best = std::min({best, at_inner, at_outer});
  }
  return best;
}

}  // namespace

std::vector<UnsafePart> unsafe_parts(const SafeSet& safe_set) {
  std::vector<UnsafePart> parts;
  const Eigen::Index dim = safe_set.dim();
  const UnsafePart everything{.box = {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                                      .upper = Eigen::VectorXd::Constant(dim, kInfinity)},
                              .axes = {}};
  for (Eigen::Index axis = 0; axis < dim; ++axis) {
    UnsafePart part = everything;
    part.axes = {axis};
    if (std::isfinite(safe_set.bounds.lower[axis])) {
      part.box.upper[axis] = safe_set.bounds.lower[axis];
      parts.push_back(part);
      part.box.upper[axis] = kInfinity;
    }
    if (std::isfinite(safe_set.bounds.upper[axis])) {
      part.box.lower[axis] = safe_set.bounds.upper[axis];
      parts.push_back(part);
    }
  }
  for (const Box& obstacle : safe_set.obstacles) {
    UnsafePart part{.box = obstacle, .axes = {}};
    for (Eigen::Index axis = 0; axis < dim; ++axis) {
      if (std::isfinite(obstacle.lower[axis]) || std::isfinite(obstacle.upper[axis])) {
        part.axes.push_back(axis);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

double markov_part_bound(const PerturbedGaussian& state, const UnsafePart& part) {
  double square = 0.0;
  for (const Eigen::Index axis : part.axes) square += state.error[axis] * state.error[axis];
  if (!std::isfinite(square) || !state.law.mean.allFinite() || !state.law.covariance.allFinite()) {
    return 1.0;
  }
  const auto value = [&](double t) {
    return square / (t * t) +
           soft_part_probability(state.law.mean, state.law.covariance, part.box, t);
  };
  if (square == 0.0) return std::min(1.0, value(kSmallestReach));
  return least_on_logarithmic_scale(value, 1.02 * std::sqrt(square), kLargestRatio, kSearchSteps);
}

double tail_part_bound(const Gaussian& law, const Eigen::VectorXd& norms, int order,
                       const UnsafePart& part) {
  if (!usable(law, norms, part)) return 1.0;
  const auto value = [&](double ratio) { return widened_bound(law, norms, order, part, ratio); };
  return least_on_logarithmic_scale(value, 1.0, kLargestTailRatio, kTailSteps);
}

double far_part_bound(const Gaussian& law, const Eigen::VectorXd& norms, int order,
                      const UnsafePart& part, double enough) {
  if (!usable(law, norms, part)) return 1.0;
  const double tails = static_cast<double>(part.axes.size());
  const double ratio = std::pow(2.0 * tails / enough, 1.0 / order);
  return std::min(1.0, widened_bound(law, norms, order, part, ratio));
}

double smooth_part_bound(const PerturbedGaussian& state, const UnsafePart& part) {
  double best = 1.0;
  for (std::size_t i = 0; i < part.axes.size(); ++i) {
    best = std::min(best, smooth_slab(state, part, part.axes[i]));
    for (std::size_t j = 0; j < i; ++j) {
      best = std::min(best, smooth_rectangle(state, part, part.axes[j], part.axes[i]));
    }
  }
  return best;
}

}  // namespace qsmpc
