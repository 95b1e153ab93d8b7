#include "tests/support/point_penalty.hpp"

#include <vector>

#include "controller/planning/cost/printed_penalty.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::testing {

PenaltyValue add_penalty(const controller::Points& locations, const Eigen::VectorXd& weights,
                         const controller::SafeSet& safe_set, const controller::Penalty& penalty,
                         controller::Points& adjoint, controller::ParticleRange range) {
  PenaltyValue value;
  if (penalty.shape == controller::PenaltyShape::kThesis) {
    const controller::TermBatch batch{
        .points = locations, .weights = weights, .range = range, .gradient = adjoint};
    std::vector<std::vector<controller::AxisInterval>> obstacles;
    for (const controller::Obstacle& each : safe_set.obstacles) {
      const controller::Box& obstacle = *each.box();
      obstacles.push_back(controller::bounded_axes(obstacle));
    }
    value.box = controller::printed_bounds_penalty(controller::bounded_axes(safe_set.bounds),
                                                   penalty.box, batch);
    if (!obstacles.empty()) {
      value.obstacle = controller::printed_obstacle_penalty(obstacles, penalty.obstacle, batch);
    }
    return value;
  }
  const controller::UnsafeSet unsafe(safe_set);
  const auto batch = [&](double scale) {
    return controller::PenaltyBatch{.locations = locations,
                                    .weights = weights,
                                    .range = range,
                                    .scale = scale,
                                    .length = penalty.length,
                                    .adjoint = adjoint};
  };
  value.box = unsafe.walls().add_penalty(0, batch(penalty.box));
  for (const controller::RegionPointer& obstacle : unsafe.obstacles()) {
    value.obstacle += obstacle->add_penalty(0, batch(penalty.obstacle));
  }
  return value;
}

PenaltyValue add_penalty(const controller::Points& locations, const Eigen::VectorXd& weights,
                         const controller::SafeSet& safe_set, const controller::Penalty& penalty,
                         controller::Points& adjoint) {
  return add_penalty(locations, weights, safe_set, penalty, adjoint, {0, locations.cols()});
}

}  // namespace qsmpc::testing
