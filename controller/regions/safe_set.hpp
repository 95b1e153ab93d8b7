// The safe set (Eq. 4-7): a box in state space without a number of rectangular obstacles.
//
// Its complement, the unsafe set (unsafe_set.hpp), is closed: touching a wall or an obstacle counts
// as unsafe, so that every probability of being unsafe that is computed from it is on the cautious
// side.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/body.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// An axis-aligned box; ±infinity where a coordinate is not restricted.
struct Box {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// The states x in which every point of the body is within bounds.lower < x < bounds.upper and in
/// none of the closed boxes in `obstacles`.
struct SafeSet {
  Box bounds;
  std::vector<Box> obstacles;
  Body body{};

  [[nodiscard]] Eigen::Index dim() const { return bounds.lower.size(); }
};

/// The whole space of dimension `dim`, which nothing can leave.
[[nodiscard]] SafeSet unbounded_safe_set(Eigen::Index dim);

/// Throws std::invalid_argument, naming `name`, unless the box has `dim` coordinates, no bound is
/// NaN and lower < upper everywhere.
void check_box(const Box& box, Eigen::Index dim, const std::string& name);

/// Throws std::invalid_argument on radii or offsets that make no sense, and on discs that states of
/// dimension `dim` cannot place.
void check_body(const Body& body, Eigen::Index dim);

/// check_box for the bounds and all obstacles, check_body for the body.
void check_safe_set(const SafeSet& safe_set);

/// Euclidean distance from `point` to the box; 0 inside it.
[[nodiscard]] double distance_to_box(const Eigen::Ref<const Eigen::VectorXd>& point,
                                     const Box& box);

/// How deep `point` is inside `box`: the least distance to a face; negative outside, where only the
/// sign matters.
[[nodiscard]] double depth_in_box(const Eigen::Ref<const Eigen::VectorXd>& point, const Box& box);

/// An interval of one coordinate.
struct AxisInterval {
  int axis;
  double lower;
  double upper;
};

/// The intervals in which the box is bounded.
[[nodiscard]] std::vector<AxisInterval> bounded_axes(const Box& box);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
