#include "controller/regions/planar/shape_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "controller/regions/planar/polygon.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Variances below this share of the largest, or below the square of a nanometre, are raised to it.
constexpr double kCertainShare = 1e-12;
constexpr double kCertainVariance = 1e-18;

BoundedPart bounded(ConvexPart part, double growth) {
  part.radius += growth;
  const Circle circle = circle_about(part);
  return {.part = std::move(part), .circle = circle};
}

/// The state relative to the obstacle's uncertain place, which is independent of it: certificates
/// then treat the obstacle as being at its expected place.
class RelativeLaw {
 public:
  RelativeLaw(const SurrogateLaw& state, PlaneAxes axes, const Eigen::Matrix2d& covariance)
      : state_(state), axes_({axes.x, axes.y}), spread_(covariance), law_(state.law) {
    law_.covariance(axes_, axes_) += spread_;
    smoothing_ = [this](const std::vector<Eigen::Index>& asked) {
      Eigen::MatrixXd smoothing = state_.smoothing(asked);
      smoothing(axes_, axes_) += spread_;
      return smoothing;
    };
  }
  RelativeLaw(const RelativeLaw&) = delete;
  RelativeLaw& operator=(const RelativeLaw&) = delete;

  [[nodiscard]] SurrogateLaw surrogate() const {
    return {.law = law_,
            .error = state_.error,
            .higher = state_.higher,
            .smoothing = smoothing_,
            .worthwhile = state_.worthwhile,
            .wanted = state_.wanted,
            .useful = state_.useful};
  }

 private:
  const SurrogateLaw& state_;
  std::vector<Eigen::Index> axes_;
  Eigen::Matrix2d spread_;
  Gaussian law_;
  std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing_;
};

}  // namespace

BoundedPart PlaneMotion::of(const BoundedPart& one) const {
  BoundedPart placed = one;
  placed.part.corners = (turn * (one.part.corners.colwise() - centre)).colwise() + (centre + shift);
  placed.part.normals = turn * one.part.normals;
  placed.part.offsets.noalias() +=
      placed.part.normals.transpose() * (centre + shift) - one.part.normals.transpose() * centre;
  placed.circle.centre = of(one.circle.centre);
  return placed;
}

ShapeParts::ShapeParts(const PlanarShape& shape, double growth) {
  for (ConvexPart& part : convex_parts(shape)) {
    parts_.push_back(bounded(std::move(part), growth));
  }
  if (parts_.size() > 1) {
    hull_ = bounded(convex_hull(std::get<PolygonShape>(shape).corners), growth);
  }
}

std::vector<HalfSpace> ShapeParts::half_space_cover(
    const Eigen::Ref<const Eigen::VectorXd>& towards, PlaneAxes axes,
    const PlaneMotion& motion) const {
  Eigen::Vector2d direction = plane_point(towards, axes);
  if (towards.squaredNorm() > direction.squaredNorm()) return {};
  Eigen::Vector2d unmoved = motion.turn.transpose() * direction;
  const bool is_half_plane = parts_.size() == 1 && parts_[0].part.corners.cols() == 0;
  if (is_half_plane) {
    unmoved = -parts_[0].part.normals.col(0);
    direction = motion.turn * unmoved;
  }
  double least = kInfinity;
  for (const BoundedPart& one : parts_) least = std::min(least, -support(one.part, -unmoved));
  least += direction.dot(motion.of(Eigen::Vector2d::Zero()));
  if (!std::isfinite(least)) return {};
  HalfSpace space{.normal = Eigen::VectorXd::Zero(towards.size()), .offset = least};
  space.normal[axes.x] = direction.x();
  space.normal[axes.y] = direction.y();
  return {space};
}

SurfacePoint ShapeParts::nearest(const Eigen::Vector2d& point, double enough) const {
  SurfacePoint least{.distance = kInfinity};
  for (const BoundedPart& one : parts_) {
    const double limit = std::min(enough, least.distance);
    if (is_beyond(one.circle, point, limit)) continue;
    const SurfacePoint surface = nearest_surface(one.part, point);
    if (surface.distance < least.distance) least = surface;
  }
  return least;
}

template <class Far, class Near>
RegionProbability ShapeParts::sum_of(double worthwhile, const Far& far, const Near& near) const {
  RegionProbability total;
  for (const BoundedPart& one : parts_) {
    const double beyond = far(one.circle);
    total += beyond <= kNegligiblePart ? RegionProbability{.markov = beyond, .smooth = beyond}
                                       : near(one);
  }
  // Parts share edges, at which the error counts for each part: for small parts their hull gives a
  // better bound.
  if (hull_ && total.smooth > worthwhile) {
    const RegionProbability bound = near(*hull_);
    total.markov = std::min(total.markov, bound.markov);
    total.smooth = std::min(total.smooth, bound.smooth);
  }
  return total;
}

RegionProbability ShapeParts::probability(const SurrogateLaw& state, PlaneAxes axes) const {
  return sum_of(
      state.worthwhile, [&](const Circle& circle) { return far_probability(state, circle, axes); },
      [&](const BoundedPart& one) { return convex_probability(state, one.part, axes); });
}

RegionProbability ShapeParts::probability(const SurrogateLaw& state, PlaneAxes axes,
                                          const PlacedAs& where) const {
  std::optional<RelativeLaw> relative;  // made when first needed
  return sum_of(
      state.worthwhile,
      [&](Circle circle) {
        circle.centre = where.motion.of(circle.centre);
        return far_probability(state, circle, axes, where.covariance);
      },
      [&](const BoundedPart& one) {
        if (!relative) relative.emplace(state, axes, where.covariance);
        return convex_probability(relative->surrogate(), where.motion.of(one).part, axes);
      });
}

double soft_probability_of(const ConvexPart& part, const Eigen::Vector2d& centre,
                           const Eigen::Matrix2d& covariance, double t) {
  const double deviation = std::sqrt(std::max(0.0, covariance.trace()));
  if (nearest_surface(part, centre).distance + 2.0 * deviation <= 0.5 * t) return 1.0;
  return soft_part_probability(soft_convex(part, centre, covariance), t);
}

SoftShape::SoftShape(const std::vector<BoundedPart>& parts, PlaneAxes axes,
                     const GaussianCentres& centres, const Eigen::Matrix2d& covariance)
    : parts_(parts),
      axes_(axes),
      centres_(centres.centres),
      covariance_(covariance),
      deviation_(std::sqrt(std::max(0.0, covariance.trace()))) {
  const Eigen::Vector2d lowest = plane_point(centres.lowest, axes);
  const Eigen::Vector2d highest = plane_point(centres.highest, axes);
  for (const BoundedPart& one : parts) {
    const Eigen::Vector2d& centre = one.circle.centre;
    const Eigen::Vector2d nearest = centre.cwiseMax(lowest).cwiseMin(highest);
    gaps_.push_back((nearest - centre).norm() - one.circle.radius);
  }
}

void SoftShape::add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const BoundedPart& one = parts_[k];
    if (gaps_[k] - t > kTail * deviation_) {
      for (Eigen::Index i = 0; i < count; ++i) totals[i] += 2.0 * kTailAllowance;
      continue;
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector2d centre(centres_(axes_.x, begin + i), centres_(axes_.y, begin + i));
      const double gap = (centre - one.circle.centre).norm() - one.circle.radius;
      // Both the inside and the surrounding within t are in the tail.
      totals[i] += gap - t > kTail * deviation_
                       ? 2.0 * kTailAllowance
                       : soft_probability_of(one.part, centre, covariance_, t);
    }
  }
}

Eigen::Matrix2d plane_covariance(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                 PlaneAxes axes) {
  Eigen::Matrix2d plane;
  plane << covariance(axes.x, axes.x), covariance(axes.x, axes.y), covariance(axes.y, axes.x),
      covariance(axes.y, axes.y);
  return plane;
}

double least_variance(double largest) {
  return std::max(kCertainVariance, kCertainShare * largest);
}

Eigen::Matrix2d uncertain(Eigen::Matrix2d covariance, double largest) {
  const double floor = least_variance(largest);
  covariance.diagonal() = covariance.diagonal().cwiseMax(floor);
  const double most = (1.0 - 1e-12) * std::sqrt(covariance(0, 0) * covariance(1, 1));
  covariance(0, 1) = covariance(1, 0) = std::clamp(covariance(0, 1), -most, most);
  return covariance;
}

void add_planar_tail(const Gaussian& law, std::span<const BoundedPart> parts, PlaneAxes axes,
                     TailSum& sum) {
  const Eigen::Vector2d mean = plane_point(law.mean, axes);
  const Eigen::Matrix2d covariance =
      uncertain(plane_covariance(law.covariance, axes), law.covariance.diagonal().maxCoeff());
  const double reach = kNoTail * std::sqrt(covariance.trace());
  const std::array<Eigen::Index, 2> plane = {axes.x, axes.y};
  for (const BoundedPart& one : parts) {
    if (is_beyond(one.circle, mean, reach)) continue;
    const PlanarSeparation apart = separation(one.part, mean, covariance);
    sum.add(apart.z, plane, std::array<double, 2>{apart.slope.x(), apart.slope.y()});
  }
}

Outline outline_in(const Eigen::Matrix2Xd& outline, PlaneAxes axes, Eigen::Index x,
                   Eigen::Index y) {
  if (x == axes.x && y == axes.y) return {.corners = outline};
  if (x == axes.y && y == axes.x) return {.corners = outline.colwise().reverse()};
  // In a plane with other coordinates only the extent is visible.
  Eigen::Matrix2Xd corners(2, 4);
  const auto side = [&](Eigen::Index axis, bool upper) {
    const int row = axis == axes.x ? 0 : 1;
    if (axis != axes.x && axis != axes.y) return upper ? kInfinity : -kInfinity;
    return upper ? outline.row(row).maxCoeff() : outline.row(row).minCoeff();
  };
  corners << side(x, false), side(x, true), side(x, true), side(x, false),  //
      side(y, false), side(y, false), side(y, true), side(y, true);
  return {.corners = corners, .depends_on_others = true};
}

double largest_variance(const Eigen::Matrix2d& covariance) {
  const double mean = 0.5 * covariance.trace();
  const double half = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return mean + std::sqrt(half * half + covariance(0, 1) * covariance(0, 1));
}

Hinge hinge(double ratio) {
  if (ratio >= 1.0) return {};
  if (ratio <= 0.0) return {.value = 0.5 - ratio, .slope = -1.0};
  return {.value = 0.5 * (1.0 - ratio) * (1.0 - ratio), .slope = ratio - 1.0};
}

}  // namespace qsmpc::controller
