#include "harness/figures/ground_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace qsmpc::harness {
namespace {

MapRectangle rectangle_of(const controller::Box& box, const models::SystemDescription& system) {
  return {.x_lower = box.lower[system.position_x],
          .x_upper = box.upper[system.position_x],
          .y_lower = box.lower[system.position_y],
          .y_upper = box.upper[system.position_y]};
}

std::string label(const models::Coordinate& state) { return state.name + " (" + state.unit + ")"; }

/// Whether the box restricts nothing but the position, so that it is unsafe as a whole.
bool is_planar(const controller::Box& box, const models::SystemDescription& system) {
  for (Eigen::Index i = 0; i < box.lower.size(); ++i) {
    if (i == system.position_x || i == system.position_y) continue;
    if (std::isfinite(box.lower[i]) || std::isfinite(box.upper[i])) return false;
  }
  return true;
}

}  // namespace

bool has_position(const models::SystemDescription& system) {
  return system.position_x >= 0 && system.position_y >= 0;
}

MapPoint map_point(const Eigen::Ref<const Eigen::VectorXd>& state,
                   const models::SystemDescription& system) {
  if (state.size() <= std::max(system.position_x, system.position_y)) {
    return {.x = std::numeric_limits<double>::quiet_NaN()};
  }
  return {.x = state[system.position_x], .y = state[system.position_y]};
}

PlaneMap ground_map(const Scenario& scenario, const models::SystemDescription& system) {
  PlaneMap map{.x_label = label(system.states[static_cast<std::size_t>(system.position_x)]),
               .y_label = label(system.states[static_cast<std::size_t>(system.position_y)]),
               .bounds = rectangle_of(scenario.safe_set.bounds, system),
               .targets = {{.centre = map_point(scenario.target.state, system),
                            .radius = scenario.target.radius}}};
  for (const controller::Box& obstacle : scenario.safe_set.obstacles) {
    auto& boxes = is_planar(obstacle, system) ? map.obstacles : map.partial_obstacles;
    boxes.push_back(rectangle_of(obstacle, system));
  }
  return map;
}

}  // namespace qsmpc::harness
