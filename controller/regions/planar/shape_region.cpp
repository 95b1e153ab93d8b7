#include "controller/regions/planar/shape_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/planar/polygon.hpp"
#include "controller/regions/soft_part.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Variances below this share of the largest, or below the square of a nanometre, are taken to be
// it: a law that is certain has no standard deviation to count in.
constexpr double kCertainShare = 1e-12;
constexpr double kCertainVariance = 1e-18;

/// A part with what tells quickly that it is far away.
struct BoundedPart {
  ConvexPart part;
  Circle circle;
};

/// Whether the point is at least `distance` away from the circle.
bool is_beyond(const Circle& circle, const Eigen::Vector2d& point, double distance) {
  const double reach = circle.radius + distance;
  return reach <= 0.0 || (point - circle.centre).squaredNorm() >= reach * reach;
}

/// h of planning/cost/penalty.hpp, and its derivative by the ratio.
struct Hinge {
  double value;
  double slope;
};
Hinge hinge(double ratio) {
  if (ratio >= 1.0) return {.value = 0.0, .slope = 0.0};
  if (ratio <= 0.0) return {.value = 0.5 - ratio, .slope = -1.0};
  return {.value = 0.5 * (1.0 - ratio) * (1.0 - ratio), .slope = ratio - 1.0};
}

/// The parts as Gaussians of one covariance about many centres see them.
class SoftShape final : public SoftRegion {
 public:
  SoftShape(const std::vector<BoundedPart>& parts, PlaneAxes axes, const GaussianCentres& centres)
      : parts_(parts), axes_(axes), centres_(centres.centres) {
    const std::vector<Eigen::Index> plane = {axes.x, axes.y};
    covariance_ = centres.covariance(plane, plane);
    deviation_ = std::sqrt(std::max(0.0, covariance_.trace()));
    const Eigen::Vector2d lowest = centres.lowest(plane);
    const Eigen::Vector2d highest = centres.highest(plane);
    for (const BoundedPart& one : parts) {
      const Eigen::Vector2d& centre = one.circle.centre;
      const Eigen::Vector2d nearest = centre.cwiseMax(lowest).cwiseMin(highest);
      gaps_.push_back((nearest - centre).norm() - one.circle.radius);
    }
  }

  void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const override {
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const BoundedPart& one = parts_[k];
      if (gaps_[k] - t > kTail * deviation_) {
        for (Eigen::Index i = 0; i < count; ++i) totals[i] += 2.0 * kTailAllowance;
        continue;
      }
      for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Vector2d centre(centres_(axes_.x, begin + i), centres_(axes_.y, begin + i));
        const double gap = (centre - one.circle.centre).norm() - one.circle.radius;
        // Both what is inside and what is within t of it is tail.
        totals[i] += gap - t > kTail * deviation_
                         ? 2.0 * kTailAllowance
                         : soft_part_probability(soft_convex(one.part, centre, covariance_), t);
      }
    }
  }

 private:
  const std::vector<BoundedPart>& parts_;
  PlaneAxes axes_;
  const Points& centres_;
  Eigen::Matrix2d covariance_;
  double deviation_;
  std::vector<double> gaps_;  ///< least distances of a centre from each part's circle
};

class ShapeRegion final : public UnsafeRegion {
 public:
  ShapeRegion(const PlanarShape& shape, const Growth& growth)
      : axes_{.x = growth.x, .y = growth.y}, outline_(shape_outline(shape)) {
    for (ConvexPart& part : convex_parts(shape)) {
      part.radius += growth.radius;
      const Circle circle = circle_about(part);
      parts_.push_back({.part = std::move(part), .circle = circle});
    }
    if (parts_.size() > 1) {
      hull_ = convex_hull(std::get<PolygonShape>(shape).corners);
      hull_->radius += growth.radius;
    }
  }

  [[nodiscard]] double signed_distance(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& point) const override {
    return nearest({point[axes_.x], point[axes_.y]}, kInfinity).distance;
  }

  void lower_to_distances(Eigen::Index /*stage*/, const Points& points,
                          Eigen::ArrayXd& least) const override {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      least[i] = std::min(least[i], nearest(at(points, i), least[i]).distance);
    }
  }

  void lower_to_faces(Eigen::Index /*stage*/, const Points& points,
                      NearestFaces& nearest_faces) const override {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const SurfacePoint surface = nearest(at(points, i), nearest_faces.distance[i]);
      if (!(surface.distance < nearest_faces.distance[i])) continue;
      nearest_faces.distance[i] = surface.distance;
      nearest_faces.slope.col(i).setZero();
      nearest_faces.slope(axes_.x, i) = surface.outward.x();
      nearest_faces.slope(axes_.y, i) = surface.outward.y();
    }
  }

  double add_penalty(Eigen::Index /*stage*/, const PenaltyBatch& batch) const override {
    double value = 0.0;
    for (Eigen::Index i = batch.range.begin; i < batch.range.end; ++i) {
      const SurfacePoint surface = nearest(at(batch.locations, i), batch.length);
      const Hinge push = hinge(surface.distance / batch.length);
      if (push.value == 0.0) continue;
      const double weight = batch.scale * batch.weights[i];
      value += weight * push.value;
      const double slope = weight * push.slope / batch.length;
      batch.adjoint(axes_.x, i) += slope * surface.outward.x();
      batch.adjoint(axes_.y, i) += slope * surface.outward.y();
    }
    return value;
  }

  void add_probability(Eigen::Index /*stage*/, const SurrogateLaw& state,
                       RegionProbability& sum) const override {
    RegionProbability total;
    for (const BoundedPart& one : parts_) {
      const double far = far_probability(state, one.circle, axes_);
      const RegionProbability bound = far <= kNegligiblePart
                                          ? RegionProbability{.markov = far, .smooth = far}
                                          : convex_probability(state, one.part, axes_);
      total.markov += bound.markov;
      total.smooth += bound.smooth;
    }
    // Parts share edges, at which each counts what the error may do: all of them at once are better
    // where they are small.
    if (hull_ && total.smooth > state.worthwhile) {
      const RegionProbability bound = convex_probability(state, *hull_, axes_);
      total.markov = std::min(total.markov, bound.markov);
      total.smooth = std::min(total.smooth, bound.smooth);
    }
    sum.markov += total.markov;
    sum.smooth += total.smooth;
  }

  void add_tail(Eigen::Index /*stage*/, const Gaussian& law, TailSum& sum) const override {
    const Eigen::Vector2d mean(law.mean[axes_.x], law.mean[axes_.y]);
    const double floor =
        std::max(kCertainVariance, kCertainShare * law.covariance.diagonal().maxCoeff());
    Eigen::Matrix2d covariance = covariance_in(law.covariance);
    covariance.diagonal() = covariance.diagonal().cwiseMax(floor);
    const double most = (1.0 - 1e-12) * std::sqrt(covariance(0, 0) * covariance(1, 1));
    covariance(0, 1) = covariance(1, 0) = std::clamp(covariance(0, 1), -most, most);
    // Beyond it the tail is 0 in doubles.
    constexpr double kNoTail = 39.0;
    const double reach = kNoTail * std::sqrt(covariance.trace());
    const std::array<Eigen::Index, 2> plane = {axes_.x, axes_.y};
    for (const BoundedPart& one : parts_) {
      if (is_beyond(one.circle, mean, reach)) continue;
      const PlanarSeparation apart = separation(one.part, mean, covariance);
      sum.add(apart.z, plane, std::array<double, 2>{apart.slope.x(), apart.slope.y()});
    }
  }

  [[nodiscard]] double soft_probability(Eigen::Index /*stage*/,
                                        const Eigen::Ref<const Eigen::VectorXd>& mean,
                                        const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                        double t) const override {
    const Eigen::Vector2d centre(mean[axes_.x], mean[axes_.y]);
    double sum = 0.0;
    for (const BoundedPart& one : parts_) {
      sum += soft_part_probability(soft_convex(one.part, centre, covariance_in(covariance)), t);
    }
    return sum;
  }

  [[nodiscard]] std::unique_ptr<const SoftRegion> soften(
      Eigen::Index /*stage*/, const GaussianCentres& centres) const override {
    return std::make_unique<const SoftShape>(parts_, axes_, centres);
  }

  [[nodiscard]] Outline outline(Eigen::Index /*stage*/, Eigen::Index x,
                                Eigen::Index y) const override {
    if (x == axes_.x && y == axes_.y) return {.corners = outline_};
    if (x == axes_.y && y == axes_.x) return {.corners = outline_.colwise().reverse()};
    // Of a plane that it is seen in from the side: from where to where.
    Eigen::Matrix2Xd corners(2, 4);
    const auto side = [&](Eigen::Index axis, bool upper) {
      const int row = axis == axes_.x ? 0 : 1;
      if (axis != axes_.x && axis != axes_.y) return upper ? kInfinity : -kInfinity;
      return upper ? outline_.row(row).maxCoeff() : outline_.row(row).minCoeff();
    };
    corners << side(x, false), side(x, true), side(x, true), side(x, false),  //
        side(y, false), side(y, false), side(y, true), side(y, true);
    return {.corners = corners, .depends_on_others = true};
  }

 private:
  [[nodiscard]] Eigen::Vector2d at(const Points& points, Eigen::Index i) const {
    return {points(axes_.x, i), points(axes_.y, i)};
  }

  [[nodiscard]] Eigen::Matrix2d covariance_in(
      const Eigen::Ref<const Eigen::MatrixXd>& covariance) const {
    Eigen::Matrix2d plane;
    plane << covariance(axes_.x, axes_.x), covariance(axes_.x, axes_.y),
        covariance(axes_.y, axes_.x), covariance(axes_.y, axes_.y);
    return plane;
  }

  /// The surface of the nearest part of those that are nearer than `enough`; else at least as far.
  [[nodiscard]] SurfacePoint nearest(const Eigen::Vector2d& point, double enough) const {
    SurfacePoint least{.distance = kInfinity};
    for (const BoundedPart& one : parts_) {
      const double limit = std::min(enough, least.distance);
      if (is_beyond(one.circle, point, limit)) continue;
      const SurfacePoint surface = nearest_surface(one.part, point);
      if (surface.distance < least.distance) least = surface;
    }
    return least;
  }

  PlaneAxes axes_;
  std::vector<BoundedPart> parts_;
  std::optional<ConvexPart> hull_;  ///< of several parts
  Eigen::Matrix2Xd outline_;        ///< of the shape itself
};

}  // namespace

RegionPointer make_shape(const PlanarShape& shape, const Growth& growth) {
  return std::make_shared<const ShapeRegion>(shape, growth);
}

}  // namespace qsmpc::controller
