#include "controller/regions/safe_set.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/constants.hpp"

namespace qsmpc::controller {

SafeSet unbounded_safe_set(Eigen::Index dim) {
  return {.bounds = {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                     .upper = Eigen::VectorXd::Constant(dim, kInfinity)},
          .obstacles = {}};
}

std::vector<const Obstacle*> moving_obstacles(const SafeSet& safe_set) {
  std::vector<const Obstacle*> moving;
  for (const Obstacle& obstacle : safe_set.obstacles) {
    if (obstacle.motion) moving.push_back(&obstacle);
  }
  return moving;
}

void check_box(const Box& box, Eigen::Index dim, const std::string& name) {
  if (box.lower.size() != dim || box.upper.size() != dim) {
    throw std::invalid_argument(name + ": lower and upper need " + std::to_string(dim) +
                                " entries each");
  }
  if (!(box.lower.array() < box.upper.array()).all()) {
    throw std::invalid_argument(name + ": lower must be less than upper in every coordinate");
  }
}

void check_body(const Body& body, Eigen::Index dim) {
  const auto is_state = [dim](int index) { return index >= 0 && index < dim; };
  if (!body.is_point() && !is_state(body.x) && !is_state(body.y)) {
    throw std::invalid_argument("body: discs need a position");
  }
  for (const Disc& disc : body.discs) {
    if (!(disc.radius >= 0.0) || std::isinf(disc.radius) || !disc.offset.allFinite()) {
      throw std::invalid_argument("body: radii must be finite and ≥ 0, offsets finite");
    }
    const bool placed = is_state(body.x) && is_state(body.y) && is_state(body.heading);
    if (!disc.offset.isZero(0.0) && !placed) {
      throw std::invalid_argument("body: a disc offset from the position needs x, y and heading");
    }
  }
}

void check_safe_set(const SafeSet& safe_set) {
  check_box(safe_set.bounds, safe_set.dim(), "safe set bounds");
  const auto is_state = [&](int index) { return index >= 0 && index < safe_set.dim(); };
  for (const Obstacle& obstacle : safe_set.obstacles) {
    if (obstacle.motion) models::check_obstacle_motion(*obstacle.motion);
    if (const Box* box = obstacle.box()) {
      if (obstacle.motion) throw std::invalid_argument("obstacle: only planar shapes can move");
      check_box(*box, safe_set.dim(), "obstacle");
      continue;
    }
    check_planar_shape(*obstacle.shape());
    if (!is_state(safe_set.body.x) || !is_state(safe_set.body.y)) {
      throw std::invalid_argument("obstacle: a shape needs a position in the plane");
    }
  }
  if (safe_set.forecast && safe_set.forecast->size() != moving_obstacles(safe_set).size()) {
    throw std::invalid_argument("safe set: the forecast must cover every moving obstacle");
  }
  if (safe_set.road && (!is_state(safe_set.body.x) || !is_state(safe_set.body.y))) {
    throw std::invalid_argument("safe set: a road needs a position in the plane");
  }
  check_body(safe_set.body, safe_set.dim());
}

double distance_to_box(const Eigen::Ref<const Eigen::VectorXd>& point, const Box& box) {
  return (box.lower - point).cwiseMax(point - box.upper).cwiseMax(0.0).norm();
}

double depth_in_box(const Eigen::Ref<const Eigen::VectorXd>& point, const Box& box) {
  return std::min((point - box.lower).minCoeff(), (box.upper - point).minCoeff());
}

std::vector<AxisInterval> bounded_axes(const Box& box) {
  std::vector<AxisInterval> intervals;
  for (Eigen::Index axis = 0; axis < box.lower.size(); ++axis) {
    if (std::isinf(box.lower[axis]) && std::isinf(box.upper[axis])) continue;
    intervals.push_back({static_cast<int>(axis), box.lower[axis], box.upper[axis]});
  }
  return intervals;
}

}  // namespace qsmpc::controller
