#include "controller/regions/box_part.hpp"

#include <algorithm>
#include <cmath>

#include "controller/measure/normal/normal_distribution.hpp"
#include "controller/regions/box_part_bound.hpp"
#include "controller/regions/box_part_norm_bound.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// A bound of a part at or below this value is not refined.
constexpr double kNegligibleTail = 1e-8;

}  // namespace

std::vector<BoxPart> half_spaces(const Box& bounds) {
  std::vector<BoxPart> parts;
  const Eigen::Index dim = bounds.lower.size();
  const BoxPart everything{.box = {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                                   .upper = Eigen::VectorXd::Constant(dim, kInfinity)},
                           .axes = {}};
  for (Eigen::Index axis = 0; axis < dim; ++axis) {
    BoxPart part = everything;
    part.axes = {axis};
    if (std::isfinite(bounds.lower[axis])) {
      part.box.upper[axis] = bounds.lower[axis];
      parts.push_back(part);
      part.box.upper[axis] = kInfinity;
    }
    if (std::isfinite(bounds.upper[axis])) {
      part.box.lower[axis] = bounds.upper[axis];
      parts.push_back(part);
    }
  }
  return parts;
}

BoxPart box_part(const Box& box) {
  BoxPart part{.box = box, .axes = {}};
  for (const AxisInterval& interval : bounded_axes(box)) part.axes.push_back(interval.axis);
  return part;
}

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

void add_part_probability(const SurrogateLaw& state, const BoxPart& part, RegionProbability& sum) {
  // A single evaluation at the highest order settles distant parts.
  const std::size_t highest = kHigherOrders.size() - 1;
  double markov = far_region_bound(state.law, state.higher[highest], kHigherOrders[highest], part,
                                   kNegligibleTail);
  double smooth = markov;
  const bool least = state.wanted == WantedBounds::kLeast;
  const double enough = std::max(state.worthwhile, kNegligibleTail);
  const auto reached = [&] { return least ? std::min(smooth, state.useful) : smooth; };
  const auto useful = [&] { return least ? std::max(reached(), enough) : 1.0; };
  if (markov > kNegligibleTail) {
    const Eigen::MatrixXd smoothing = state.smoothing(part.axes);
    const PerturbedGaussian perturbed{
        .law = state.law, .error = state.error, .smoothing = smoothing};
    smooth = std::min(smooth, smooth_region_bound(perturbed, part));
    markov = std::min(markov, markov_region_bound(perturbed, part, useful()));
    smooth = std::min(smooth, markov);
  }
  // Searches in two coordinates are expensive: done only where they can matter.
  for (std::size_t k = kHigherOrders.size(); k-- > 0 && reached() > state.worthwhile;) {
    markov = std::min(
        markov, tail_region_bound(state.law, state.higher[k], kHigherOrders[k], part, useful()));
    smooth = std::min(smooth, markov);
  }
  sum.markov += markov;
  sum.smooth += smooth;
}

BoxSurface box_surface(const Points& points, Eigen::Index i,
                       const std::vector<AxisInterval>& intervals) {
  BoxSurface surface;
  double squares = 0.0;
  double depth = kInfinity;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const double below = points(intervals[k].axis, i) - intervals[k].lower;
    const double above = intervals[k].upper - points(intervals[k].axis, i);
    const double least = std::min(below, above);
    if (least < 0.0) squares += least * least;
    if (least >= depth) continue;
    depth = least;
    surface.face = k;
    surface.outward = below < above ? -1.0 : 1.0;
  }
  surface.distance = depth >= 0.0 ? -depth : std::sqrt(squares);
  return surface;
}

void BoxSurface::write_slope(const Points& points, Eigen::Index i,
                             const std::vector<AxisInterval>& intervals, double sign,
                             Points& slope) const {
  slope.col(i).setZero();
  if (intervals.empty()) return;
  if (!(distance > 0.0)) {
    slope(intervals[face].axis, i) = sign * outward;
    return;
  }
  for (const AxisInterval& interval : intervals) {
    const double x = points(interval.axis, i);
    const double beyond = std::max(0.0, x - interval.upper) - std::max(0.0, interval.lower - x);
    slope(interval.axis, i) = sign * beyond / distance;
  }
}

Eigen::Matrix2Xd rectangle_corners(const Box& box, Eigen::Index x, Eigen::Index y) {
  const auto lower = [&](Eigen::Index axis) { return axis < 0 ? -kInfinity : box.lower[axis]; };
  const auto upper = [&](Eigen::Index axis) { return axis < 0 ? kInfinity : box.upper[axis]; };
  Eigen::Matrix2Xd corners(2, 4);
  corners << lower(x), upper(x), upper(x), lower(x),  //
      lower(y), lower(y), upper(y), upper(y);
  return corners;
}

}  // namespace qsmpc::controller
