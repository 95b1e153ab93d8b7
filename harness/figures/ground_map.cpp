#include "harness/figures/ground_map.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "controller/regions/planar/road_walls.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/figures/palette.hpp"
#include "harness/scenario/target_course.hpp"
#include "harness/text/unit_text.hpp"

namespace qsmpc::harness {
namespace {

MapRectangle rectangle_of(const controller::Outline& outline) {
  const Eigen::Vector2d lower = outline.corners.rowwise().minCoeff();
  const Eigen::Vector2d upper = outline.corners.rowwise().maxCoeff();
  return {.x_lower = lower.x(), .x_upper = upper.x(), .y_lower = lower.y(), .y_upper = upper.y()};
}

/// The polygon as an axis-aligned rectangle, if it is one.
std::optional<MapRectangle> as_rectangle(const controller::Outline& outline) {
  const MapRectangle sides = rectangle_of(outline);
  if (outline.corners.cols() != 4) return std::nullopt;
  for (const auto& corner : outline.corners.colwise()) {
    const bool on_side = (corner.x() == sides.x_lower || corner.x() == sides.x_upper) &&
                         (corner.y() == sides.y_lower || corner.y() == sides.y_upper);
    if (!on_side) return std::nullopt;
  }
  return sides;
}

MapPolygon polygon_of(const controller::Outline& outline) {
  MapPolygon polygon;
  for (const auto& corner : outline.corners.colwise()) {
    polygon.corners.push_back({.x = corner.x(), .y = corner.y()});
  }
  return polygon;
}

void add_obstacle(const controller::Outline& outline, PlaneMap& map) {
  if (const std::optional<MapRectangle> box = as_rectangle(outline)) {
    (outline.depends_on_others ? map.partial_obstacles : map.obstacles).push_back(*box);
  } else {
    map.polygons.push_back(polygon_of(outline));
  }
}

/// The obstacle as a half-plane, if it is one; as a finite outline it would be truncated.
const controller::HalfPlaneShape* half_plane_of(const controller::Obstacle& obstacle) {
  const controller::PlanarShape* shape = obstacle.shape();
  return shape == nullptr ? nullptr : std::get_if<controller::HalfPlaneShape>(shape);
}

MapPath line_through(const Eigen::Matrix2Xd& points, bool closed) {
  MapPath line{.colour = kGrey};
  for (const auto& point : points.colwise())
    line.points.push_back({.x = point.x(), .y = point.y()});
  if (closed && !line.points.empty()) line.points.push_back(line.points.front());
  return line;
}

/// Adds the centre line of the path to follow, and the edges of its road.
void add_road(const Scenario& scenario, PlaneMap& map) {
  const Scenario::Target& target = scenario.target;
  if (!target.course) return;
  MapPath centre = line_through(centre_line(*target.course->path), false);
  centre.name = "path to follow";
  centre.dashed = true;
  map.lines.push_back(std::move(centre));
  if (scenario.safe_set.road == nullptr) return;
  const controller::RoadEdges& edges = scenario.safe_set.road->edges();
  for (const Eigen::Matrix2Xd* edge : {&edges.left, &edges.right}) {
    MapPath line = line_through(*edge, edges.closed);
    line.name = "edge of the road";
    map.lines.push_back(std::move(line));
  }
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
  if (const auto& route = scenario.target.route) {
    for (Eigen::Index i = 0; i + 1 < route->states.cols(); ++i) {
      map.targets.push_back({.centre = map_point(route->states.col(i), system),
                             .radius = route->radius,
                             .is_waypoint = true});
    }
  }
  // Shapes live in the plane of position, which the map's axes show if there is one.
  for (std::size_t k = 0; k < scenario.safe_set.obstacles.size(); ++k) {
    if (const auto* half_plane = half_plane_of(scenario.safe_set.obstacles[k])) {
      map.half_planes.push_back(
          {.normal = {.x = half_plane->normal.x(), .y = half_plane->normal.y()},
           .offset = half_plane->offset});
    } else {
      add_obstacle(outline_of(*unsafe.obstacles()[k]), map);
    }
  }
  add_road(scenario, map);
  return map;
}

}  // namespace qsmpc::harness
