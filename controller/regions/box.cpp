// A closed box: an obstacle.
#include <algorithm>
#include <cmath>
#include <optional>

#include "controller/regions/box_part.hpp"
#include "controller/regions/distance_kernels.hpp"
#include "controller/regions/penalty_kernels.hpp"
#include "controller/regions/planar/shape_parts.hpp"
#include "controller/regions/shapes.hpp"
#include "controller/regions/soft_part.hpp"
#include "controller/regions/soft_region.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

class BoxRegion final : public UnsafeRegion {
 public:
  /// `grown` contains every point nearer than `radius` to `core`.
  BoxRegion(const Box& core, double radius, const Box& grown)
      : core_(core),
        core_intervals_(bounded_axes(core)),
        radius_(radius),
        part_(box_part(grown)),
        intervals_(bounded_axes(grown)) {
    if (radius > 0.0 && core_intervals_.size() == 2 && has_four_sides()) {
      axes_ = {.x = core_intervals_[0].axis, .y = core_intervals_[1].axis};
      rounded_.emplace(PolygonShape{.corners = rectangle_corners(core, axes_.x, axes_.y)}, radius);
    }
  }

  [[nodiscard]] double signed_distance(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& point) const override {
    const double depth = depth_in_box(point, core_);
    return (depth >= 0.0 ? -depth : distance_to_box(point, core_)) - radius_;
  }

  void lower_to_distances(Eigen::Index /*stage*/, const Points& points,
                          Eigen::ArrayXd& least) const override {
    lower_to_box_distances(core_intervals_, radius_, points, least);
  }

  void lower_to_faces(Eigen::Index /*stage*/, const Points& points,
                      NearestFaces& nearest) const override {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const BoxSurface surface = box_surface(points, i, core_intervals_);
      const double distance = surface.distance - radius_;
      if (!(distance < nearest.distance[i])) continue;
      nearest.distance[i] = distance;
      surface.write_slope(points, i, core_intervals_, 1.0, nearest.slope);
    }
  }

  double add_penalty(Eigen::Index /*stage*/, const PenaltyBatch& batch) const override {
    return box_penalty(intervals_, batch);
  }

  void add_probability(Eigen::Index /*stage*/, const SurrogateLaw& state,
                       RegionProbability& sum) const override {
    RegionProbability bound;
    add_part_probability(state, part_, bound);
    if (rounded_) lower_at_corner(state, bound);
    sum += bound;
  }

  void add_tail(Eigen::Index /*stage*/, const Gaussian& law, TailSum& sum) const override {
    if (rounded_) {
      add_planar_tail(law, rounded_->all(), axes_, sum);
    } else {
      add_part_tail(law, part_, sum);
    }
  }

  [[nodiscard]] double soft_probability(Eigen::Index /*stage*/,
                                        const Eigen::Ref<const Eigen::VectorXd>& mean,
                                        const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                        double t) const override {
    return soft_part_probability(mean, covariance, part_.box, t);
  }

  [[nodiscard]] std::unique_ptr<const SoftRegion> soften(
      Eigen::Index /*stage*/, const GaussianCentres& centres) const override {
    return soft_box(part_.box, centres);
  }

  [[nodiscard]] std::vector<HalfSpace> half_space_cover(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& towards) const override {
    double least = 0.0;
    double squares = 0.0;
    Eigen::VectorXd beyond = towards;
    for (const AxisInterval& interval : core_intervals_) {
      const double along = towards[interval.axis];
      if (along != 0.0) least += along * (along > 0.0 ? interval.lower : interval.upper);
      squares += along * along;
      beyond[interval.axis] = 0.0;
    }
    const double offset = least - radius_ * std::sqrt(squares);
    if (!beyond.isZero(0.0) || !std::isfinite(offset)) return {};
    return {{.normal = towards, .offset = offset}};
  }

  [[nodiscard]] Outline outline(Eigen::Index /*stage*/, Eigen::Index x,
                                Eigen::Index y) const override {
    const auto is_other = [&](const AxisInterval& interval) {
      return interval.axis != x && interval.axis != y;
    };
    return {.corners = rectangle_corners(part_.box, x, y),
            .depends_on_others = std::any_of(intervals_.begin(), intervals_.end(), is_other)};
  }

 private:
  [[nodiscard]] bool has_four_sides() const {
    return std::ranges::all_of(core_intervals_, [](const AxisInterval& interval) {
      return std::isfinite(interval.lower) && std::isfinite(interval.upper) &&
             interval.lower < interval.upper;
    });
  }

  /// The grown box has sharp corners. Where the mean is nearest to one of them, most of what the
  /// law has in the box may be in what the rounded corner lacks.
  void lower_at_corner(const SurrogateLaw& state, RegionProbability& bound) const {
    const bool both = state.wanted == WantedBounds::kBoth;
    const double reached = both ? bound.markov : std::min(bound.smooth, state.useful);
    if (reached <= (both ? kNegligiblePart : std::max(state.worthwhile, kNegligiblePart))) return;
    const Eigen::Vector2d mean = plane_point(state.law.mean, axes_);
    const Eigen::Vector2d outward = rounded_->nearest(mean, kInfinity).outward;
    if (outward.x() == 0.0 || outward.y() == 0.0) return;
    const RegionProbability rounded = rounded_->probability(state, axes_);
    bound.markov = std::min(bound.markov, rounded.markov);
    bound.smooth = std::min(bound.smooth, rounded.smooth);
  }

  Box core_;
  std::vector<AxisInterval> core_intervals_;
  double radius_;
  BoxPart part_;
  std::vector<AxisInterval> intervals_;
  PlaneAxes axes_;                     ///< of rounded_
  std::optional<ShapeParts> rounded_;  ///< the grown rectangle, if it has (round) corners
};

}  // namespace

RegionPointer make_box(const Box& intervals, const Growth& growth) {
  Box grown = intervals;
  bool position_alone = true;
  for (const AxisInterval& interval : bounded_axes(intervals)) {
    if (growth.grows(interval.axis)) {
      grown.lower[interval.axis] -= growth.radius;
      grown.upper[interval.axis] += growth.radius;
    } else {
      position_alone = false;
    }
  }
  // The radius is a distance in the plane; it has no meaning combined with other coordinates.
  if (position_alone) {
    return std::make_shared<const BoxRegion>(intervals, growth.radius, grown);
  }
  return std::make_shared<const BoxRegion>(grown, 0.0, grown);
}

}  // namespace qsmpc::controller
