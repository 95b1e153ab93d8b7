#include "controller/certification/smoothed_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include "controller/measure/normal_distribution.hpp"

namespace qsmpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond this many standard deviations a normal tail is below 1e-17; it counts as kTailAllowance.
constexpr double kTail = 8.6;
constexpr double kTailAllowance = 1e-17;
constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
// t is searched over radius · 1.02 … radius · 1.02 · 2^kOctaves, then about the best of these.
constexpr int kOctaves = 24;
constexpr int kBisections = 5;

/// E[(1 − (D − y)²/t²); D − t ≤ y ≤ D] for y ~ N(0, s²): what lies within t before a wall at D.
double before_wall(double wall, double deviation, double t) {
  if (wall - t > kTail * deviation || wall < -kTail * deviation) return kTailAllowance;
  const double low = (wall - t) / deviation;
  const double high = wall / deviation;
  // Rounding of two neighbouring values of Φ must not make a mass negative.
  const double mass = std::max(0.0, normal_probability(low, high));
  const double first = deviation * (normal_density(low) - normal_density(high));
  const double second =
      deviation * deviation * (mass + normal_density_moment(low) - normal_density_moment(high));
  const double squares = wall * wall * mass - 2.0 * wall * first + second;
  const double rounding = kRounding * (wall * wall + deviation * deviation) / (t * t);
  return std::clamp(mass - squares / (t * t) + rounding, 0.0, mass);
}

/// At least E(1 − d(y, H)²/t²)₊ for the half-space H = {z : normal·z ≥ offset}, |normal| = 1.
double soft_half_space(const Eigen::VectorXd& normal, double offset, const Eigen::VectorXd& mean,
                       const Eigen::MatrixXd& covariance, double t) {
  const double deviation = std::sqrt(std::max(0.0, normal.dot(covariance * normal)));
  return soft_interval_probability(normal.dot(mean), deviation, offset, kInfinity, t);
}

/// The half-space with inner normal along `direction` that touches `box` from outside `mean`, or 1
/// if the direction does not separate them. A half-space that contains the obstacle is nearer than
/// it, so its value is an upper bound.
double separating_half_space(const Eigen::VectorXd& direction, const Eigen::VectorXd& mean,
                             const Eigen::MatrixXd& covariance, const Box& box, double t) {
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return 1.0;
  const Eigen::VectorXd normal = direction / length;
  double offset = 0.0;  // min over the box of normal·z
  for (Eigen::Index axis = 0; axis < normal.size(); ++axis) {
    if (normal[axis] == 0.0) continue;
    offset += normal[axis] * (normal[axis] > 0.0 ? box.lower[axis] : box.upper[axis]);
  }
  return std::isfinite(offset) ? soft_half_space(normal, offset, mean, covariance, t) : 1.0;
}

/// Σ⁻¹ `across` in the coordinates in which `box` is bounded, 0 in the others: the direction in
/// which the box is the most standard deviations away.
Eigen::VectorXd whitened_direction(const Eigen::VectorXd& across, const Eigen::MatrixXd& covariance,
                                   const Box& box) {
  std::vector<Eigen::Index> bounded;
  for (Eigen::Index axis = 0; axis < across.size(); ++axis) {
    if (std::isfinite(box.lower[axis]) || std::isfinite(box.upper[axis])) bounded.push_back(axis);
  }
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(across.size());
  const Eigen::MatrixXd marginal = covariance(bounded, bounded);
  const Eigen::VectorXd offset = across(bounded);
  const Eigen::VectorXd solution = marginal.ldlt().solve(offset);
  direction(bounded) = solution;
  return direction;
}

bool diagonal_on(const Eigen::Ref<const Eigen::MatrixXd>& covariance, const Box& box) {
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const bool both = (std::isfinite(box.lower[i]) || std::isfinite(box.upper[i])) &&
                        (std::isfinite(box.lower[j]) || std::isfinite(box.upper[j]));
      if (both && covariance(i, j) != 0.0) return false;
    }
  }
  return true;
}

/// E(1 − d(y, U)²/t²)₊ of the mixture; a part of it, at least `enough`, once it is that much.
double mixture_value(const DiscreteMeasure& centres,
                     const Eigen::Ref<const Eigen::MatrixXd>& covariance, const SafeSet& safe_set,
                     double t, double enough = kInfinity) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < centres.size() && sum < enough; ++i) {
    if (centres.weights[i] == 0.0) continue;
    sum += centres.weights[i] *
           soft_unsafe_probability(centres.locations.col(i), covariance, safe_set, t);
  }
  return sum;
}

}  // namespace

double soft_interval_probability(double mean, double deviation, double lower, double upper,
                                 double t) {
  if (deviation == 0.0) {
    const double distance = std::max({lower - mean, mean - upper, 0.0});
    return std::max(0.0, 1.0 - distance * distance / (t * t));
  }
  // Most points are far from most faces: both what is inside and what is within t of it is tail.
  const double gap = std::max(lower - mean, mean - upper);
  if (gap - t > kTail * deviation) return 2.0 * kTailAllowance;
  const double inside = normal_probability((lower - mean) / deviation, (upper - mean) / deviation);
  const double below = std::isinf(lower) ? 0.0 : before_wall(lower - mean, deviation, t);
  const double above = std::isinf(upper) ? 0.0 : before_wall(mean - upper, deviation, t);
  return std::min(1.0, inside + below + above + kTailAllowance);
}

// 1 − Σ_a d_a²/t² ≤ Π_a (1 − d_a²/t²)₊ where the left side is positive, and independent coordinates
// factor. For correlated ones any single axis, and any half-space that contains the box,
// serve.
double soft_part_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                             const Eigen::Ref<const Eigen::MatrixXd>& covariance, const Box& box,
                             double t) {
  const bool independent = diagonal_on(covariance, box);
  double product = 1.0;
  double least = 1.0;
  for (Eigen::Index axis = 0; axis < mean.size(); ++axis) {
    const double factor = soft_interval_probability(mean[axis], std::sqrt(covariance(axis, axis)),
                                                    box.lower[axis], box.upper[axis], t);
    product *= factor;
    least = std::min(least, factor);
  }
  if (independent) return product;
  const Eigen::VectorXd nearest = mean.cwiseMax(box.lower).cwiseMin(box.upper);
  const Eigen::VectorXd across = nearest - mean;
  const Eigen::VectorXd whitened = whitened_direction(across, covariance, box);
  return std::min({least, separating_half_space(across, mean, covariance, box, t),
                   separating_half_space(whitened, mean, covariance, box, t)});
}

double soft_unsafe_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                               const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                               const SafeSet& safe_set, double t) {
  double sum = 0.0;
  for (Eigen::Index axis = 0; axis < mean.size(); ++axis) {
    const double deviation = std::sqrt(covariance(axis, axis));
    const double lower = safe_set.bounds.lower[axis];
    const double upper = safe_set.bounds.upper[axis];
    if (!std::isinf(lower)) {
      sum += soft_interval_probability(mean[axis], deviation, -kInfinity, lower, t);
    }
    if (!std::isinf(upper)) {
      sum += soft_interval_probability(mean[axis], deviation, upper, kInfinity, t);
    }
  }
  for (const Box& obstacle : safe_set.obstacles) {
    sum += soft_part_probability(mean, covariance, obstacle, t);
  }
  return std::min(1.0, sum);
}

double smoothed_probability(const DiscreteMeasure& centres,
                            const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                            const SafeSet& safe_set, double radius, double useful_below) {
  if (!std::isfinite(radius) || !centres.locations.allFinite()) return 1.0;
  if (radius == 0.0) return mixture_value(centres, covariance, safe_set, kSmallestReach);
  // A value below `useful_below` needs radius²/t² below it, hence a t beyond this one; and the
  // spread grows with t.
  const double useful = std::clamp(useful_below, kTailAllowance, 1.0);
  const double first = radius / std::sqrt(useful);
  if (mixture_value(centres, covariance, safe_set, first, useful) >= useful) return 1.0;
  double best_t = first;
  double best = 1.0;
  const auto evaluate = [&](double t) {
    const double spread = mixture_value(centres, covariance, safe_set, t);
    const double here = radius * radius / (t * t) + spread;
    if (here < best) {
      best = here;
      best_t = t;
    }
    return spread;
  };
  double t = 1.02 * first;
  for (int octave = 0; octave <= kOctaves; ++octave, t *= 2.0) {
    if (evaluate(t) >= std::min(best, useful)) break;  // no larger t can be better
  }
  double ratio = std::sqrt(2.0);
  for (int step = 0; step < kBisections; ++step, ratio = std::sqrt(ratio)) {
    const double centre = best_t;
    evaluate(centre / ratio);
    if (best_t == centre) evaluate(centre * ratio);
  }
  return std::min(1.0, best);
}

}  // namespace qsmpc
