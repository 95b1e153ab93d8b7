// Building blocks of the regions of stationary and moving shapes: the grown convex parts of a
// shape, with bounding circles for quick tests whether a part is far away.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/convex_bound.hpp"
#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

/// A part with its bounding circle.
struct BoundedPart {
  ConvexPart part;
  Circle circle;
};

/// A rotation of the plane about a point, followed by a translation.
struct PlaneMotion {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();  ///< a rotation

  [[nodiscard]] Eigen::Vector2d of(const Eigen::Vector2d& point) const {
    return centre + shift + turn * (point - centre);
  }
  /// The inverse: the point that is moved to `point`.
  [[nodiscard]] Eigen::Vector2d back(const Eigen::Vector2d& point) const {
    return centre + turn.transpose() * (point - centre - shift);
  }
  [[nodiscard]] BoundedPart of(const BoundedPart& one) const;
};

/// The place of parts: moved by `motion`, plus a Gaussian displacement in the plane with this
/// covariance.
struct PlacedAs {
  PlaneMotion motion{};
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// Whether the point is at least `distance` away from the circle.
[[nodiscard]] inline bool is_beyond(const Circle& circle, const Eigen::Vector2d& point,
                                    double distance) {
  const double reach = circle.radius + distance;
  return reach <= 0.0 || (point - circle.centre).squaredNorm() >= reach * reach;
}

class ShapeParts {
 public:
  /// The shape and all points within `growth` of it. `shape` must pass check_planar_shape.
  ShapeParts(const PlanarShape& shape, double growth);

  [[nodiscard]] const std::vector<BoundedPart>& all() const { return parts_; }

  /// The surface of the nearest part if it is nearer than `enough`; otherwise one at least as far
  /// as `enough`.
  [[nodiscard]] SurfacePoint nearest(const Eigen::Vector2d& point, double enough) const;

  /// Bounds of P(z + e in the parts).
  [[nodiscard]] RegionProbability probability(const SurrogateLaw& state, PlaneAxes axes) const;
  /// The same for parts at the random place `where`, which is independent of the state.
  [[nodiscard]] RegionProbability probability(const SurrogateLaw& state, PlaneAxes axes,
                                              const PlacedAs& where) const;

  /// The half-space with the normal `towards` (state_dim) that contains the moved parts, or the
  /// half-plane itself if the shape is one. Empty if there is no such half-space or `towards` is
  /// not in the plane.
  [[nodiscard]] std::vector<HalfSpace> half_space_cover(
      const Eigen::Ref<const Eigen::VectorXd>& towards, PlaneAxes axes,
      const PlaneMotion& motion) const;

 private:
  /// The sum over the parts of the bound `far` for distant parts and `near` for all others, or the
  /// bound `near` of the hull if that is less.
  template <class Far, class Near>
  [[nodiscard]] RegionProbability sum_of(double worthwhile, const Far& far, const Near& near) const;

  std::vector<BoundedPart> parts_;
  std::optional<BoundedPart> hull_;  ///< if there are several parts
};

/// An upper bound of E(1 − d(y, part)²/t²)₊ for y ~ N(centre, covariance). Where it would be near 1
/// anyway, as for a part much nearer than t, it is 1, which saves the computation.
[[nodiscard]] double soft_probability_of(const ConvexPart& part, const Eigen::Vector2d& centre,
                                         const Eigen::Matrix2d& covariance, double t);

/// Parts prepared for Gaussians of one covariance about many centres.
class SoftShape final : public SoftRegion {
 public:
  /// `covariance`: in the plane. Keeps references to the parts and the centres.
  SoftShape(const std::vector<BoundedPart>& parts, PlaneAxes axes, const GaussianCentres& centres,
            const Eigen::Matrix2d& covariance);

  void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const override;

 private:
  const std::vector<BoundedPart>& parts_;
  PlaneAxes axes_;
  const Points& centres_;
  Eigen::Matrix2d covariance_;
  double deviation_;
  std::vector<double> gaps_;  ///< least distances of a centre from each part's circle
};

/// A Gaussian's mean and covariance in the plane.
[[nodiscard]] inline Eigen::Vector2d plane_point(const Eigen::Ref<const Eigen::VectorXd>& state,
                                                 PlaneAxes axes) {
  return {state[axes.x], state[axes.y]};
}
[[nodiscard]] Eigen::Matrix2d plane_covariance(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                               PlaneAxes axes);

/// The threshold of certainty: a smaller variance has no usable standard deviation to measure
/// distances in. largest: the largest variance of the whole law.
[[nodiscard]] double least_variance(double largest);

/// The covariance with its variances raised to at least that threshold.
[[nodiscard]] Eigen::Matrix2d uncertain(Eigen::Matrix2d covariance, double largest);

/// Adds the tails of the law in each of the parts to `sum`, as UnsafeRegion::add_tail does.
void add_planar_tail(const Gaussian& law, std::span<const BoundedPart> parts, PlaneAxes axes,
                     TailSum& sum);

/// An outline given in the plane of `axes`, shown in the plane of state coordinates x and y: itself
/// if these are `axes`, otherwise the rectangle of its extent.
[[nodiscard]] Outline outline_in(const Eigen::Matrix2Xd& corners, PlaneAxes axes, Eigen::Index x,
                                 Eigen::Index y);

/// The penalty h of planning/cost/penalty.hpp and its derivative, for a distance in units of the
/// penalty's length.
struct Hinge {
  double value = 0.0;
  double slope = 0.0;
};
[[nodiscard]] Hinge hinge(double ratio);

/// The largest variance in any direction.
[[nodiscard]] double largest_variance(const Eigen::Matrix2d& covariance);

/// Shared by the queries about many points. `nearest(point, enough)` returns the nearest surface if
/// it is nearer than `enough`; otherwise one at least that far away.
///
/// Lowers `least` (n) to the distances of the points.
template <class Nearest>
void lower_distances(const Nearest& nearest, PlaneAxes axes, const Points& points,
                     Eigen::ArrayXd& least) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector2d at(points(axes.x, i), points(axes.y, i));
    least[i] = std::min(least[i], nearest(at, least[i]).distance);
  }
}

/// The same with the slopes.
template <class Nearest>
void lower_faces(const Nearest& nearest, PlaneAxes axes, const Points& points,
                 NearestFaces& faces) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector2d at(points(axes.x, i), points(axes.y, i));
    const SurfacePoint surface = nearest(at, faces.distance[i]);
    if (!(surface.distance < faces.distance[i])) continue;
    faces.distance[i] = surface.distance;
    faces.slope.col(i).setZero();
    faces.slope(axes.x, i) = surface.outward.x();
    faces.slope(axes.y, i) = surface.outward.y();
  }
}

/// Returns `scale` times the penalty of the batch's particles and adds its derivatives to the
/// adjoint.
template <class Nearest>
double add_penalty_of(const Nearest& nearest, PlaneAxes axes, double scale,
                      const PenaltyBatch& batch) {
  double value = 0.0;
  for (Eigen::Index i = batch.range.begin; i < batch.range.end; ++i) {
    const Eigen::Vector2d at(batch.locations(axes.x, i), batch.locations(axes.y, i));
    const SurfacePoint surface = nearest(at, batch.length);
    const Hinge push = hinge(surface.distance / batch.length);
    if (push.value == 0.0) continue;
    const double weight = scale * batch.weights[i];
    value += weight * push.value;
    const double slope = weight * push.slope / batch.length;
    batch.adjoint(axes.x, i) += slope * surface.outward.x();
    batch.adjoint(axes.y, i) += slope * surface.outward.y();
  }
  return value;
}

}  // namespace qsmpc::controller
