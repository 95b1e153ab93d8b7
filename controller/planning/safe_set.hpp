// The safe set (Eq. 4-7): a box in state space without a number of rectangular obstacles.
//
// Its complement, the unsafe set, is closed: touching a wall or an obstacle counts as unsafe, so
// that every probability of being unsafe that is computed from it is on the cautious side.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// An axis-aligned box; ±infinity where a coordinate is not restricted.
struct Box {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// {x : bounds.lower < x < bounds.upper} without the closed boxes in `obstacles`.
struct SafeSet {
  Box bounds;
  std::vector<Box> obstacles;

  [[nodiscard]] Eigen::Index dim() const { return bounds.lower.size(); }
};

/// The whole space of dimension `dim`, which nothing can leave.
[[nodiscard]] SafeSet unbounded_safe_set(Eigen::Index dim);

/// Throws std::invalid_argument unless all sizes agree, no bound is NaN, lower < upper everywhere.
void check_safe_set(const SafeSet& safe_set);

/// Euclidean distance from `point` to the box; 0 inside it.
[[nodiscard]] double distance_to_box(const Eigen::Ref<const Eigen::VectorXd>& point,
                                     const Box& box);

/// Distance to the unsafe set: 0 in it, otherwise the least over the faces of `bounds` and over
/// the obstacles (docs/theory/certificates.md; the thesis's Algorithm 3 takes a norm over the
/// dimensions instead, which overestimates, and leaves the obstacles out).
[[nodiscard]] double distance_to_unsafe(const Eigen::Ref<const Eigen::VectorXd>& point,
                                        const SafeSet& safe_set);

/// Distance to the unsafe set outside of it; inside it, minus the depth: the least distance that
/// leads out of the obstacle, or back into `bounds`. Reports use it as the clearance.
[[nodiscard]] double clearance(const Eigen::Ref<const Eigen::VectorXd>& point,
                               const SafeSet& safe_set);

/// The clearances of all points (dim x n); −infinity where a coordinate is not finite.
[[nodiscard]] Eigen::VectorXd clearances(const Points& points, const SafeSet& safe_set);

}  // namespace qsmpc::controller
