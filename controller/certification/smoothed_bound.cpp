#include "controller/certification/smoothed_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {
// Beyond this many standard deviations a normal tail is below 1e-17; it counts as kTailAllowance.
constexpr double kTail = 8.6;
constexpr double kTailAllowance = 1e-17;
constexpr double kWallRounding = 8.0 * std::numeric_limits<double>::epsilon();
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
  const double rounding = kWallRounding * (wall * wall + deviation * deviation) / (t * t);
  return std::clamp(mass - squares / (t * t) + rounding, 0.0, mass);
}

/// Adds the half-space with inner normal along `direction` that touches `box` from outside `mean`,
/// if the direction separates them. A half-space that contains the obstacle is nearer than it, so
/// its value is an upper bound.
void add_separating_half_space(const Eigen::VectorXd& direction,
                               const Eigen::Ref<const Eigen::VectorXd>& mean,
                               const Eigen::Ref<const Eigen::MatrixXd>& covariance, const Box& box,
                               SoftPart& part) {
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return;
  const Eigen::VectorXd normal = direction / length;
  double offset = 0.0;  // min over the box of normal·z
  for (Eigen::Index axis = 0; axis < normal.size(); ++axis) {
    if (normal[axis] == 0.0) continue;
    offset += normal[axis] * (normal[axis] > 0.0 ? box.lower[axis] : box.upper[axis]);
  }
  if (!std::isfinite(offset)) return;
  part.intervals.push_back(
      {.lower = offset - normal.dot(mean),
       .upper = kInfinity,
       .deviation = std::sqrt(std::max(0.0, normal.dot(covariance * normal)))});
}

/// Σ⁻¹ `across` in the coordinates in which `box` is bounded, 0 in the others: the direction in
/// which the box is the most standard deviations away.
Eigen::VectorXd whitened_direction(const Eigen::VectorXd& across,
                                   const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                   const Box& box) {
  std::vector<Eigen::Index> bounded;
  for (Eigen::Index axis = 0; axis < across.size(); ++axis) {
    if (std::isfinite(box.lower[axis]) || std::isfinite(box.upper[axis])) bounded.push_back(axis);
  }
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(across.size());
  const auto count = static_cast<Eigen::Index>(bounded.size());
  Eigen::MatrixXd marginal(count, count);
  Eigen::VectorXd offset(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    offset[j] = across[bounded[j]];
    for (Eigen::Index i = 0; i < count; ++i) marginal(i, j) = covariance(bounded[i], bounded[j]);
  }
  const Eigen::VectorXd solution = models::solve_symmetric(marginal, offset);
  for (Eigen::Index i = 0; i < count; ++i) direction[bounded[i]] = solution[i];
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

/// E(1 − d(y, U)²/t²)₊ of a Gaussian mixture, by vectors of its centres.
class SoftMixture {
 public:
  SoftMixture(const GaussianMixture& mixture, const SafeSet& safe_set) : mixture_(mixture) {
    lowest_ = mixture.centres.rowwise().minCoeff();
    highest_ = mixture.centres.rowwise().maxCoeff();
    for (Eigen::Index axis = 0; axis < mixture.centres.rows(); ++axis) {
      const double lower = safe_set.bounds.lower[axis];
      const double upper = safe_set.bounds.upper[axis];
      if (!std::isinf(lower)) add_factor(axis, -kInfinity, lower, true);
      if (!std::isinf(upper)) add_factor(axis, upper, kInfinity, true);
    }
    for (const Box& obstacle : safe_set.obstacles) {
      if (diagonal_on(mixture.covariance, obstacle)) {
        add_obstacle(obstacle);
      } else {
        correlated_.push_back(&obstacle);
      }
    }
  }

  /// At least the value; a part of it, at least `enough`, once it is that much. 0 < t.
  [[nodiscard]] double value(double t, double enough = kInfinity) const {
    const Eigen::Index size = mixture_.centres.cols();
    double sum = 0.0;
    // Where a part may be enough, the first centres may be.
    Eigen::Index block = std::isinf(enough) ? kBlock : kFirstBlock;
    for (Eigen::Index begin = 0; begin < size && sum < enough; begin += block) {
      if (begin > 0) block = kBlock;
      const Eigen::Index count = std::min(block, size - begin);
      std::array<double, kBlock> total{};
      add_independent(t, begin, count, total.data());
      for (Eigen::Index i = 0; i < count; ++i) {
        for (const Box* obstacle : correlated_) {
          total[i] += soft_part_probability(mixture_.centres.col(begin + i), mixture_.covariance,
                                            *obstacle, t);
        }
        sum += mixture_.weights[begin + i] * std::min(1.0, total[i]);
      }
    }
    return sum;
  }

 private:
  static constexpr Eigen::Index kBlock = 64;
  static constexpr Eigen::Index kFirstBlock = 8;

  /// One axis of a face or an obstacle; the values of its axes are multiplied.
  struct Factor {
    Eigen::Index axis;
    SoftInterval interval;
    double gap;    ///< least distance of a centre
    bool is_last;  ///< of its part
  };

  void add_factor(Eigen::Index axis, double lower, double upper, bool is_last) {
    const double deviation = std::sqrt(std::max(0.0, mixture_.covariance(axis, axis)));
    factors_.push_back({.axis = axis,
                        .interval = {.lower = lower, .upper = upper, .deviation = deviation},
                        .gap = std::max({0.0, lower - highest_[axis], lowest_[axis] - upper}),
                        .is_last = is_last});
  }

  void add_obstacle(const Box& obstacle) {
    const std::size_t before = factors_.size();
    for (Eigen::Index axis = 0; axis < obstacle.lower.size(); ++axis) {
      if (std::isinf(obstacle.lower[axis]) && std::isinf(obstacle.upper[axis])) continue;
      add_factor(axis, obstacle.lower[axis], obstacle.upper[axis], false);
    }
    // One that is everywhere has no axis of its own.
    if (factors_.size() == before) add_factor(0, -kInfinity, kInfinity, true);
    factors_.back().is_last = true;
  }

  void add_independent(double t, Eigen::Index begin, Eigen::Index count, double* total) const {
    for (std::size_t first = 0; first < factors_.size();) {
      std::size_t end = first;
      bool far = false;
      do {
        // Both what is inside and what is within t of it is tail, of all centres.
        far = far || factors_[end].gap - t > kTail * factors_[end].interval.deviation;
      } while (!factors_[end++].is_last);
      if (far) {
        for (Eigen::Index i = 0; i < count; ++i) total[i] += 2.0 * kTailAllowance;
      } else {
        add_part(t, first, end, begin, count, total);
      }
      first = end;
    }
  }

  void add_part(double t, std::size_t first, std::size_t end, Eigen::Index begin,
                Eigen::Index count, double* total) const {
    std::array<double, kBlock> product;
    std::array<double, kBlock> factor;
    product.fill(1.0);
    for (std::size_t k = first; k < end; ++k) {
      soft_interval_by_mean(factors_[k].interval, t, &mixture_.centres(factors_[k].axis, begin),
                            static_cast<std::size_t>(count), factor.data());
      for (Eigen::Index i = 0; i < count; ++i) product[i] *= factor[i];
    }
    for (Eigen::Index i = 0; i < count; ++i) total[i] += product[i];
  }

  const GaussianMixture& mixture_;
  Eigen::VectorXd lowest_;
  Eigen::VectorXd highest_;
  std::vector<Factor> factors_;
  std::vector<const Box*> correlated_;
};

/// The same one by one, with allowances that serve the smallest t as well.
double precise_value(const GaussianMixture& mixture, const SafeSet& safe_set, double t) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < mixture.centres.cols(); ++i) {
    if (mixture.weights[i] == 0.0) continue;
    sum += mixture.weights[i] *
           soft_unsafe_probability(mixture.centres.col(i), mixture.covariance, safe_set, t);
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
SoftPart soft_part(const Eigen::Ref<const Eigen::VectorXd>& mean,
                   const Eigen::Ref<const Eigen::MatrixXd>& covariance, const Box& box) {
  SoftPart part{.intervals = {}, .independent = diagonal_on(covariance, box)};
  part.intervals.reserve(static_cast<std::size_t>(mean.size()) + 2);
  for (Eigen::Index axis = 0; axis < mean.size(); ++axis) {
    if (std::isinf(box.lower[axis]) && std::isinf(box.upper[axis])) continue;
    part.intervals.push_back({.lower = box.lower[axis] - mean[axis],
                              .upper = box.upper[axis] - mean[axis],
                              .deviation = std::sqrt(covariance(axis, axis))});
  }
  if (part.independent) return part;
  const Eigen::VectorXd across = mean.cwiseMax(box.lower).cwiseMin(box.upper) - mean;
  add_separating_half_space(across, mean, covariance, box, part);
  add_separating_half_space(whitened_direction(across, covariance, box), mean, covariance, box,
                            part);
  return part;
}

double soft_part_probability(const SoftPart& part, double t) {
  double result = 1.0;
  for (const SoftInterval& interval : part.intervals) {
    const double factor =
        soft_interval_probability(0.0, interval.deviation, interval.lower, interval.upper, t);
    result = part.independent ? result * factor : std::min(result, factor);
  }
  return result;
}

double soft_part_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                             const Eigen::Ref<const Eigen::MatrixXd>& covariance, const Box& box,
                             double t) {
  return soft_part_probability(soft_part(mean, covariance, box), t);
}

void soft_part_by_reach(const SoftPart& part, const double* reaches, double* out) {
  std::fill_n(out, kSoftReaches, 1.0);
  std::array<double, kSoftReaches> factor;
  for (const SoftInterval& interval : part.intervals) {
    soft_interval_by_reach(interval, reaches, kSoftReaches, factor.data());
    for (std::size_t k = 0; k < kSoftReaches; ++k) {
      out[k] = part.independent ? out[k] * factor[k] : std::min(out[k], factor[k]);
    }
  }
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

double smoothed_probability(const GaussianMixture& mixture, const SafeSet& safe_set, double radius,
                            double useful_below) {
  if (!std::isfinite(radius) || !mixture.centres.allFinite()) return 1.0;
  if (radius == 0.0) return precise_value(mixture, safe_set, kSmallestReach);
  // A value below `useful_below` needs radius²/t² below it, hence a t beyond this one; and the
  // spread grows with t.
  const double useful = std::clamp(useful_below, kTailAllowance, 1.0);
  const double first = radius / std::sqrt(useful);
  const SoftMixture soft(mixture, safe_set);
  if (soft.value(first, useful) >= useful) return 1.0;
  double best_t = first;
  double best = 1.0;
  const auto evaluate = [&](double t) {
    const double spread = soft.value(t);
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

}  // namespace qsmpc::controller
