#include "controller/regions/soft_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

constexpr double kWallRounding = 8.0 * std::numeric_limits<double>::epsilon();

/// E[(1 − (D − y)²/t²); D − t ≤ y ≤ D] for y ~ N(0, s²): the contribution of the points within t
/// before a wall at D.
double before_wall(double wall, double deviation, double t) {
  if (wall - t > kTail * deviation || wall < -kTail * deviation) return kTailAllowance;
  const double low = (wall - t) / deviation;
  const double high = wall / deviation;
  // Rounding of two nearby values of Φ must not make the mass negative.
  const double mass = std::max(0.0, normal_probability(low, high));
  const double first = deviation * (normal_density(low) - normal_density(high));
  const double second =
      deviation * deviation * (mass + normal_density_moment(low) - normal_density_moment(high));
  const double squares = wall * wall * mass - 2.0 * wall * first + second;
  const double rounding = kWallRounding * (wall * wall + deviation * deviation) / (t * t);
  return std::clamp(mass - squares / (t * t) + rounding, 0.0, mass);
}

/// Adds the half-space with inner normal along `direction` whose boundary touches `box`, if the
/// direction is non-zero and the offset finite. A half-space that contains the obstacle is at least
/// as near as the obstacle, so its value is an upper bound.
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

}  // namespace

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

double soft_interval_probability(double mean, double deviation, double lower, double upper,
                                 double t) {
  if (deviation == 0.0) {
    const double distance = std::max({lower - mean, mean - upper, 0.0});
    return std::max(0.0, 1.0 - distance * distance / (t * t));
  }
  // Most points are far from most faces: then both the inside and the surrounding within t are in
  // the tail.
  const double gap = std::max(lower - mean, mean - upper);
  if (gap - t > kTail * deviation) return 2.0 * kTailAllowance;
  const double inside = normal_probability((lower - mean) / deviation, (upper - mean) / deviation);
  const double below = std::isinf(lower) ? 0.0 : before_wall(lower - mean, deviation, t);
  const double above = std::isinf(upper) ? 0.0 : before_wall(mean - upper, deviation, t);
  return std::min(1.0, inside + below + above + kTailAllowance);
}

// 1 − Σ_a d_a²/t² ≤ Π_a (1 − d_a²/t²)₊ where the left side is positive, and independent coordinates
// factor. For correlated ones every single axis and every half-space that contains the box gives a
// bound.
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

}  // namespace qsmpc::controller
