// The safe set (Eq. 4-7): a box in state space minus obstacles, which are boxes in any coordinates
// or shapes in the plane of position, and inside the road if there is one.
//
// Its complement, the unsafe set (unsafe_set.hpp), is closed: touching a wall or an obstacle counts
// as unsafe, so that every probability of being unsafe computed from it errs on the cautious side.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/body.hpp"
#include "controller/regions/planar/planar_shape.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "models/motion/obstacle_motion.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

class RoadWalls;

/// An axis-aligned box; ±infinity where a coordinate is unrestricted.
struct Box {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// A closed set that must not be entered.
struct Obstacle {
  // NOLINTBEGIN(google-explicit-constructor): a box is an obstacle, and so is a shape
  Obstacle(Box box) : form(std::move(box)) {}
  Obstacle(PlanarShape shape) : form(std::move(shape)) {}
  // NOLINTEND(google-explicit-constructor)

  std::variant<Box, PlanarShape> form;
  std::optional<models::ObstacleMotion> motion{};  ///< of a shape; empty: it stands still

  /// Null if the obstacle is a shape.
  [[nodiscard]] const Box* box() const { return std::get_if<Box>(&form); }
  /// Null if the obstacle is a box.
  [[nodiscard]] const PlanarShape* shape() const { return std::get_if<PlanarShape>(&form); }
};

/// The states x in which every point of the body is within bounds.lower < x < bounds.upper and in
/// none of the obstacles. Shapes and the road are in the plane of body.x and body.y.
struct SafeSet {
  Box bounds;
  std::vector<Obstacle> obstacles;
  Body body{};
  /// Predicted places of the moving obstacles, in the order of `obstacles`; copies share it.
  /// Without it they stand still where they are defined.
  std::shared_ptr<const ObstacleForecast> forecast{};
  /// The walls behind the edges of the road (planar/road_walls.hpp); null without a road.
  std::shared_ptr<const RoadWalls> road{};

  [[nodiscard]] Eigen::Index dim() const { return bounds.lower.size(); }
};

/// The moving obstacles, in their order.
[[nodiscard]] std::vector<const Obstacle*> moving_obstacles(const SafeSet& safe_set);

/// The whole space of dimension `dim`, which nothing can leave.
[[nodiscard]] SafeSet unbounded_safe_set(Eigen::Index dim);

/// Throws std::invalid_argument, naming `name`, unless the box has `dim` coordinates, no bound is
/// NaN and lower < upper everywhere.
void check_box(const Box& box, Eigen::Index dim, const std::string& name);

/// Throws std::invalid_argument on invalid radii or offsets, and on discs that cannot be placed by
/// states of dimension `dim`.
void check_body(const Body& body, Eigen::Index dim);

/// Applies check_box to the bounds and all boxes, check_planar_shape to all shapes,
/// check_obstacle_motion to all motions and check_body to the body. Shapes and a road need two
/// position states; only shapes may move; a forecast must be for as many obstacles as move. Throws
/// std::invalid_argument.
void check_safe_set(const SafeSet& safe_set);

/// Euclidean distance from `point` to the box; 0 inside it.
[[nodiscard]] double distance_to_box(const Eigen::Ref<const Eigen::VectorXd>& point,
                                     const Box& box);

/// How deep `point` is inside `box`: the least distance to a face; negative outside, where only the
/// sign is meaningful.
[[nodiscard]] double depth_in_box(const Eigen::Ref<const Eigen::VectorXd>& point, const Box& box);

/// An interval of one coordinate.
struct AxisInterval {
  int axis;
  double lower;
  double upper;
};

/// The intervals of the coordinates in which the box is bounded.
[[nodiscard]] std::vector<AxisInterval> bounded_axes(const Box& box);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
