#include "harness/video/episode_world.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "controller/regions/planar/road_walls.hpp"
#include "controller/regions/standing.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/scenario/target_course.hpp"
#include "harness/trace/drawn_vehicle.hpp"
#include "harness/video/episode_track.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kFlatHalfWidth = 0.5;  // of an obstacle, in a direction that the system lacks, m

// The region's sides along x and y; `missing` is half the length of a side that the system lacks.
render::PlanarRectangle planar_sides(const models::SystemDescription& system,
                                     const controller::UnsafeRegion& region, double missing) {
  const std::array<int, 2> index = {drawn_x(system), system.position_y};
  const Eigen::Matrix2Xd corners = region.outline(0, index[0], index[1]).corners;
  Eigen::Vector2d lower = corners.rowwise().minCoeff();
  Eigen::Vector2d upper = corners.rowwise().maxCoeff();
  for (int side = 0; side < 2; ++side) {
    if (index[side] >= 0) continue;
    lower[side] = -missing;
    upper[side] = missing;
  }
  return {lower.x(), upper.x(), lower.y(), upper.y()};
}

std::vector<render::PlanarPoint> points_of(const Eigen::Matrix2Xd& corners) {
  std::vector<render::PlanarPoint> points;
  for (const auto& corner : corners.colwise()) points.push_back({corner.x(), corner.y()});
  return points;
}

// Adds a shape of the plane of position.
void add_shape(const controller::PlanarShape& shape, render::World& world) {
  if (const auto* half_plane = std::get_if<controller::HalfPlaneShape>(&shape)) {
    world.half_planes.push_back(
        {{half_plane->normal.x(), half_plane->normal.y()}, half_plane->offset});
  } else {
    world.prisms.push_back(prism_of(shape));
  }
}

render::RoadLine road_line(const Eigen::Matrix2Xd& points, bool closed, bool is_edge) {
  render::RoadLine line{.points = points_of(points), .is_edge = is_edge};
  if (closed && !line.points.empty()) line.points.push_back(line.points.front());
  return line;
}

// Adds the centre line of the path to follow, and the edges of its road.
void add_road_lines(const Scenario& scenario, render::World& world) {
  if (!scenario.target.course) return;
  world.road.push_back(road_line(centre_line(*scenario.target.course->path), false, false));
  if (scenario.safe_set.road == nullptr) return;
  const controller::RoadEdges& edges = scenario.safe_set.road->edges();
  for (const Eigen::Matrix2Xd* edge : {&edges.left, &edges.right}) {
    world.road.push_back(road_line(*edge, edges.closed, true));
  }
}

controller::Box box_of(const render::PlanarRectangle& area) {
  return {.lower = Eigen::Vector2d(area.x_lower, area.y_lower),
          .upper = Eigen::Vector2d(area.x_upper, area.y_upper)};
}

controller::SafeSet in_plane(controller::Box bounds) {
  return {.bounds = std::move(bounds), .obstacles = {}, .body = {.discs = {}, .x = 0, .y = 1}};
}

// The static safe set in the plane of position: bounds and boxes as drawn, shapes and the road as
// in the scenario.
controller::SafeSet standing_in_plane(const render::World& world,
                                      const controller::SafeSet& scenario) {
  controller::SafeSet safe_set = in_plane(box_of(world.bounds));
  for (const render::PlanarRectangle& obstacle : world.obstacles) {
    safe_set.obstacles.emplace_back(box_of(obstacle));
  }
  safe_set.road = scenario.road;
  for (const controller::Obstacle& obstacle : scenario.obstacles) {
    if (obstacle.shape() != nullptr) safe_set.obstacles.push_back(obstacle);
  }
  return controller::standing(std::move(safe_set));
}

controller::SafeSet moving_in_plane(const controller::SafeSet& safe_set) {
  controller::SafeSet moving = in_plane(controller::unbounded_safe_set(2).bounds);
  for (const controller::Obstacle* one : controller::moving_obstacles(safe_set)) {
    moving.obstacles.push_back(*one);
  }
  return moving;
}

}  // namespace

render::Prism prism_of(const controller::PlanarShape& shape) {
  render::Prism prism{.outline = points_of(controller::shape_outline(shape)), .pieces = {}};
  if (std::holds_alternative<controller::PolygonShape>(shape)) {
    for (const controller::ConvexPart& part : controller::convex_parts(shape)) {
      prism.pieces.push_back(points_of(part.corners));
    }
  } else {
    prism.pieces.push_back(prism.outline);
  }
  return prism;
}

render::World episode_world(const EpisodeView& view) {
  const models::SystemDescription& system = view.system();
  const Scenario& scenario = view.scenario();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  render::World world;
  const controller::UnsafeSet unsafe(scenario.safe_set);
  world.bounds = planar_sides(system, unsafe.walls(), kFar);
  const double missing = is_on_rail(system) ? kFar : kFlatHalfWidth;
  for (std::size_t k = 0; k < scenario.safe_set.obstacles.size(); ++k) {
    const controller::Obstacle& obstacle = scenario.safe_set.obstacles[k];
    if (obstacle.motion) continue;
    if (const controller::PlanarShape* shape = obstacle.shape()) {
      add_shape(*shape, world);
    } else {
      world.obstacles.push_back(planar_sides(system, *unsafe.obstacles()[k], missing));
    }
  }
  const render::PlanarPose target = planar_pose(system, scenario.target.state);
  world.target = {target.x, target.y};
  world.target_radius = scenario.target.radius;
  if (const auto& route = scenario.target.route) {
    world.waypoint_radius = route->radius;
    for (Eigen::Index i = 0; i + 1 < route->states.cols(); ++i) {
      const render::PlanarPose at = planar_pose(system, route->states.col(i));
      world.waypoints.push_back({at.x, at.y});
    }
  }
  add_road_lines(scenario, world);
  return world;
}

PlanarClearances::PlanarClearances(const EpisodeView& view, const render::World& world,
                                   const DrivenObstacles& others)
    : standing_(standing_in_plane(world, view.scenario().safe_set)),
      moving_(moving_in_plane(view.scenario().safe_set)),
      others_(others) {}

std::vector<double> PlanarClearances::of(const std::vector<render::PlanarPoint>& points,
                                         const std::vector<double>& times) const {
  std::vector<double> clearances;
  clearances.reserve(points.size());
  for (const render::PlanarPoint& point : points) {
    clearances.push_back(controller::clearance(Eigen::Vector2d(point.x, point.y), standing_));
  }
  if (others_.empty()) return clearances;
  const auto places = std::make_shared<controller::ObstacleForecast>(others_.count());
  controller::SafeSet safe_set = moving_;
  safe_set.forecast = places;
  const controller::UnsafeSet unsafe(safe_set);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Matrix3Xd poses = others_.poses_at(times[i]);
    for (std::size_t n = 0; n < others_.count(); ++n) {
      const auto pose = poses.col(static_cast<Eigen::Index>(n));
      places->set(n, {{{.offset = pose.head<2>(), .turn = pose[2]}}});
    }
    const Eigen::Vector2d point(points[i].x, points[i].y);
    clearances[i] = std::min(clearances[i], controller::clearance(point, unsafe));
  }
  return clearances;
}

}  // namespace qsmpc::harness
