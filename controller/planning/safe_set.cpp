#include "controller/planning/safe_set.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

void check_box(const Box& box, Eigen::Index dim, const std::string& name) {
  if (box.lower.size() != dim || box.upper.size() != dim) {
    throw std::invalid_argument(name + ": lower and upper need " + std::to_string(dim) +
                                " entries each");
  }
  if (!(box.lower.array() < box.upper.array()).all()) {
    throw std::invalid_argument(name + ": lower must be less than upper in every coordinate");
  }
}

/// How deep `point` is inside `box`; negative outside, where only the sign matters.
double depth_in_box(const Eigen::Ref<const Eigen::VectorXd>& point, const Box& box) {
  return std::min((point - box.lower).minCoeff(), (box.upper - point).minCoeff());
}

}  // namespace

SafeSet unbounded_safe_set(Eigen::Index dim) {
  return {.bounds = {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                     .upper = Eigen::VectorXd::Constant(dim, kInfinity)},
          .obstacles = {}};
}

void check_safe_set(const SafeSet& safe_set) {
  check_box(safe_set.bounds, safe_set.dim(), "safe set bounds");
  for (const Box& obstacle : safe_set.obstacles) {
    check_box(obstacle, safe_set.dim(), "obstacle");
  }
}

double distance_to_box(const Eigen::Ref<const Eigen::VectorXd>& point, const Box& box) {
  return (box.lower - point).cwiseMax(point - box.upper).cwiseMax(0.0).norm();
}

double distance_to_unsafe(const Eigen::Ref<const Eigen::VectorXd>& point, const SafeSet& safe_set) {
  return std::max(0.0, clearance(point, safe_set));
}

double clearance(const Eigen::Ref<const Eigen::VectorXd>& point, const SafeSet& safe_set) {
  // Inside the bounds the depth is the distance to the nearest face; outside, minus the distance.
  const double depth = depth_in_box(point, safe_set.bounds);
  double least = depth > 0.0 ? depth : -distance_to_box(point, safe_set.bounds);
  for (const Box& obstacle : safe_set.obstacles) {
    const double depth_in_obstacle = depth_in_box(point, obstacle);
    least = std::min(
        least, depth_in_obstacle >= 0.0 ? -depth_in_obstacle : distance_to_box(point, obstacle));
  }
  return least;
}

Eigen::VectorXd clearances(const Points& points, const SafeSet& safe_set) {
  const Eigen::Index count = points.cols();
  Eigen::ArrayXd least;
  Eigen::ArrayXd depth(count);
  Eigen::ArrayXd squares(count);
  const auto measure_box = [&](const Box& box) {
    depth.setConstant(kInfinity);
    squares.setZero();
    for (Eigen::Index axis = 0; axis < safe_set.dim(); ++axis) {
      const double lower = box.lower[axis];
      const double upper = box.upper[axis];
      if (std::isinf(lower) && std::isinf(upper)) continue;
      const Eigen::Map<const Eigen::ArrayXd> x(points.data() + axis * count, count);
      depth = depth.min(x - lower).min(upper - x);
      squares += (lower - x).max(x - upper).max(0.0).square();
    }
  };
  measure_box(safe_set.bounds);
  least = (depth > 0.0).select(depth, -squares.sqrt());
  for (const Box& obstacle : safe_set.obstacles) {
    measure_box(obstacle);
    least = least.min((depth >= 0.0).select(-depth, squares.sqrt()));
  }
  // What is not a number is not safe; minima may have lost it.
  for (const auto& x : points.rowwise()) {
    least = (x.transpose().array().isFinite()).select(least, -kInfinity);
  }
  return least.matrix();
}

}  // namespace qsmpc::controller
