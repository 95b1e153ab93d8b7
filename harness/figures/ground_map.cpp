#include "harness/figures/ground_map.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "controller/regions/unsafe_set.hpp"
#include "harness/text/unit_text.hpp"

namespace qsmpc::harness {
namespace {

MapRectangle rectangle_of(const controller::Outline& outline) {
  const Eigen::Vector2d lower = outline.corners.rowwise().minCoeff();
  const Eigen::Vector2d upper = outline.corners.rowwise().maxCoeff();
  return {.x_lower = lower.x(), .x_upper = upper.x(), .y_lower = lower.y(), .y_upper = upper.y()};
}

std::string label(const models::Coordinate& state) {
  return state.name + " (" + printed_unit(state.unit) + ")";
}

}  // namespace

MapPoint map_point(const Eigen::Ref<const Eigen::VectorXd>& state,
                   const models::SystemDescription& system) {
  const std::optional<MapAxes> axes = map_axes(system);
  if (!axes || state.size() <= std::max(axes->x, axes->y)) {
    return {.x = std::numeric_limits<double>::quiet_NaN()};
  }
  return {.x = state[axes->x], .y = state[axes->y]};
}

PlaneMap ground_map(const Scenario& scenario, const models::SystemDescription& system) {
  const controller::UnsafeSet unsafe(scenario.safe_set);
  const MapAxes axes = map_axes(system).value();
  const auto outline_of = [&](const controller::UnsafeRegion& region) {
    return region.outline(0, axes.x, axes.y);
  };
  PlaneMap map{.x_label = label(system.states[static_cast<std::size_t>(axes.x)]),
               .y_label = label(system.states[static_cast<std::size_t>(axes.y)]),
               .bounds = rectangle_of(outline_of(unsafe.walls())),
               .targets = {{.centre = map_point(scenario.target.state, system),
                            .radius = scenario.target.radius}}};
  for (const controller::RegionPointer& obstacle : unsafe.obstacles()) {
    const controller::Outline outline = outline_of(*obstacle);
    auto& boxes = outline.depends_on_others ? map.partial_obstacles : map.obstacles;
    boxes.push_back(rectangle_of(outline));
  }
  return map;
}

}  // namespace qsmpc::harness
