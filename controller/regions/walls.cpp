// The walls: everything outside the safe set's bounds.
#include <algorithm>
#include <cmath>

#include "controller/regions/box_part.hpp"
#include "controller/regions/distance_kernels.hpp"
#include "controller/regions/penalty_kernels.hpp"
#include "controller/regions/shapes.hpp"
#include "controller/regions/soft_part.hpp"
#include "controller/regions/soft_region.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

class Walls final : public UnsafeRegion {
 public:
  explicit Walls(const Box& bounds)
      : bounds_(bounds), intervals_(bounded_axes(bounds)), parts_(half_spaces(bounds)) {}

  // Inside the bounds, the distance to the nearest face; outside, minus the distance to the bounds.
  [[nodiscard]] double signed_distance(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& point) const override {
    const double depth = depth_in_box(point, bounds_);
    return depth > 0.0 ? depth : -distance_to_box(point, bounds_);
  }

  void lower_to_distances(Eigen::Index /*stage*/, const Points& points,
                          Eigen::ArrayXd& least) const override {
    lower_to_wall_distances(intervals_, points, least);
  }

  void lower_to_faces(Eigen::Index /*stage*/, const Points& points,
                      NearestFaces& nearest) const override {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const BoxSurface surface = box_surface(points, i, intervals_);
      if (!(-surface.distance < nearest.distance[i])) continue;
      nearest.distance[i] = -surface.distance;
      surface.write_slope(points, i, intervals_, -1.0, nearest.slope);
    }
  }

  double add_penalty(Eigen::Index /*stage*/, const PenaltyBatch& batch) const override {
    double value = 0.0;
    for (const AxisInterval& interval : intervals_) value += wall_penalty(interval, batch);
    return value;
  }

  void add_probability(Eigen::Index /*stage*/, const SurrogateLaw& state,
                       RegionProbability& sum) const override {
    for (const BoxPart& part : parts_) add_part_probability(state, part, sum);
  }

  void add_tail(Eigen::Index /*stage*/, const Gaussian& law, TailSum& sum) const override {
    for (const BoxPart& part : parts_) add_part_tail(law, part, sum);
  }

  [[nodiscard]] double soft_probability(Eigen::Index /*stage*/,
                                        const Eigen::Ref<const Eigen::VectorXd>& mean,
                                        const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                        double t) const override {
    double sum = 0.0;
    for (const AxisInterval& interval : intervals_) {
      const double deviation = std::sqrt(covariance(interval.axis, interval.axis));
      if (!std::isinf(interval.lower)) {
        sum += soft_interval_probability(mean[interval.axis], deviation, -kInfinity, interval.lower,
                                         t);
      }
      if (!std::isinf(interval.upper)) {
        sum +=
            soft_interval_probability(mean[interval.axis], deviation, interval.upper, kInfinity, t);
      }
    }
    return sum;
  }

  [[nodiscard]] std::unique_ptr<const SoftRegion> soften(
      Eigen::Index /*stage*/, const GaussianCentres& centres) const override {
    return soft_walls(bounds_, centres);
  }

  [[nodiscard]] std::vector<HalfSpace> half_space_cover(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& towards) const override {
    std::vector<HalfSpace> faces;
    const auto add = [&](Eigen::Index axis, double sign, double end) {
      if (std::isinf(end)) return;
      const Eigen::VectorXd normal = sign * Eigen::VectorXd::Unit(towards.size(), axis);
      faces.push_back({.normal = normal, .offset = sign * end});
    };
    for (const AxisInterval& interval : intervals_) {
      add(interval.axis, -1.0, interval.lower);
      add(interval.axis, 1.0, interval.upper);
    }
    return faces;
  }

  [[nodiscard]] Outline outline(Eigen::Index /*stage*/, Eigen::Index x,
                                Eigen::Index y) const override {
    return {.corners = rectangle_corners(bounds_, x, y), .unsafe_inside = false};
  }

 private:
  Box bounds_;
  std::vector<AxisInterval> intervals_;
  std::vector<BoxPart> parts_;
};

}  // namespace

RegionPointer make_walls(const Box& intervals, const Growth& growth) {
  Box room = intervals;
  for (Eigen::Index axis = 0; axis < room.lower.size(); ++axis) {
    if (!growth.grows(axis)) continue;
    room.lower[axis] += growth.radius;
    room.upper[axis] -= growth.radius;
  }
  return std::make_shared<const Walls>(room);
}

}  // namespace qsmpc::controller
