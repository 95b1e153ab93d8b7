// The nearest point of a box in the metric of a Gaussian, in one and two coordinates.
#include <algorithm>
#include <array>
#include <cmath>

#include "controller/regions/box_part.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Variances below this share of the largest, or below the square of a nanometre, are raised to it:
// a law that is certain has no standard deviation to measure distances in.
constexpr double kLeastVarianceShare = 1e-12;
constexpr double kLeastVariance = 1e-18;

/// Distance of a law from a part, in standard deviations, and its derivative by the law's mean.
struct Separation {
  double z = kInfinity;
  std::array<Eigen::Index, 2> axes{};
  std::array<double, 2> slope{};
  std::size_t count = 0;
};

/// One coordinate: the box's interval, and the law's mean and variance.
struct Side {
  Eigen::Index axis;
  double lower;
  double upper;
  double mean;
  double variance;

  /// Distance beyond the nearest end, negative inside; and the sign of the normal there.
  [[nodiscard]] double outside() const { return std::max(lower - mean, mean - upper); }
  [[nodiscard]] double normal() const { return lower - mean > mean - upper ? -1.0 : 1.0; }
  [[nodiscard]] double end() const { return normal() < 0.0 ? lower : upper; }
};

Side side_of(const Gaussian& law, const BoxPart& part, Eigen::Index axis) {
  const double floor =
      std::max(kLeastVariance, kLeastVarianceShare * law.covariance.diagonal().maxCoeff());
  return {.axis = axis,
          .lower = part.box.lower[axis],
          .upper = part.box.upper[axis],
          .mean = law.mean[axis],
          .variance = std::max(law.covariance(axis, axis), floor)};
}

/// The separation from the half-space at the nearest end of `side`.
Separation of_half_space(const Side& side) {
  const double deviation = std::sqrt(side.variance);
  return {.z = side.outside() / deviation,
          .axes = {side.axis, side.axis},
          .slope = {side.normal() / deviation, 0.0},
          .count = 1};
}

/// The separation from a rectangle of a mean outside it whose nearest point is on the face of
/// `face`: the other coordinate of that point is the conditional mean on the face, clamped to it.
Separation of_face(const Side& face, const Side& other, double cross) {
  const double across = face.mean - face.end();
  const double along_free = -cross / face.variance * across;
  const double along = other.mean - std::clamp(other.mean + along_free, other.lower, other.upper);
  // S⁻¹ (m − x) and its norm in the metric.
  const double limit = 1.0 - 1e-12;
  const double bounded =
      std::clamp(cross / std::sqrt(face.variance * other.variance), -limit, limit);
  const double covariance = bounded * std::sqrt(face.variance * other.variance);
  const double determinant = face.variance * other.variance - covariance * covariance;
  const double w_face = (other.variance * across - covariance * along) / determinant;
  const double w_other = (face.variance * along - covariance * across) / determinant;
  const double z = std::sqrt(std::max(0.0, w_face * across + w_other * along));
  if (!(z > 1e-6)) return of_half_space(face);
  return {.z = z, .axes = {face.axis, other.axis}, .slope = {w_face / z, w_other / z}, .count = 2};
}

Separation of_rectangle(const Side& one, const Side& two, double cross) {
  const Separation by_one = of_half_space(one);
  const Separation by_two = of_half_space(two);
  // Inside, the nearest way out.
  if (by_one.z <= 0.0 && by_two.z <= 0.0) return by_one.z > by_two.z ? by_one : by_two;
  Separation nearest;
  if (by_one.z > 0.0) nearest = of_face(one, two, cross);
  if (by_two.z > 0.0) {
    const Separation other = of_face(two, one, cross);
    if (other.z < nearest.z) nearest = other;
  }
  return nearest;
}

}  // namespace

void add_part_tail(const Gaussian& law, const BoxPart& part, TailSum& sum) {
  // Nothing is added for a part without bounded axes, the whole space, or for a law that is NaN.
  Separation farthest{.z = -kInfinity};
  const auto take = [&](const Separation& one) {
    if (one.z > farthest.z) farthest = one;
  };
  if (part.axes.size() == 1) take(of_half_space(side_of(law, part, part.axes[0])));
  // In more than two coordinates every pair's rectangle contains the box; the farthest is the most
  // informative.
  for (std::size_t i = 0; i < part.axes.size(); ++i) {
    for (std::size_t j = i + 1; j < part.axes.size(); ++j) {
      const Eigen::Index a = part.axes[i];
      const Eigen::Index b = part.axes[j];
      take(of_rectangle(side_of(law, part, a), side_of(law, part, b), law.covariance(a, b)));
    }
  }
  if (farthest.count == 0) return;
  sum.add(farthest.z, std::span(farthest.axes).first(farthest.count),
          std::span(farthest.slope).first(farthest.count));
}

}  // namespace qsmpc::controller
