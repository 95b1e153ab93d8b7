#include "controller/planning/penalty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qsmpc {
namespace {

struct HingeValue {
  double value = 0.0;
  double slope = 0.0;
};

/// h(s) of the header and its derivative with respect to s.
HingeValue hinge(double signed_distance, double length) {
  const double ratio = signed_distance / length;
  if (ratio >= 1.0) return {};
  if (ratio >= 0.0) return {0.5 * (1.0 - ratio) * (1.0 - ratio), -(1.0 - ratio) / length};
  return {0.5 - ratio, -1.0 / length};
}

double smooth_box(const Points& x, Eigen::Index i, const Box& bounds, const Penalty& penalty,
                  double weight, Points& adjoint) {
  double sum = 0.0;
  for (Eigen::Index axis = 0; axis < x.rows(); ++axis) {
    const HingeValue low = hinge(x(axis, i) - bounds.lower[axis], penalty.length);
    const HingeValue high = hinge(bounds.upper[axis] - x(axis, i), penalty.length);
    sum += low.value + high.value;
    adjoint(axis, i) += weight * (low.slope - high.slope);
  }
  return weight * sum;
}

double smooth_obstacle(const Points& x, Eigen::Index i, const Box& obstacle, const Penalty& penalty,
                       double weight, Points& adjoint) {
  double squared = 0.0;  // of the distance, if outside
  double depth = std::numeric_limits<double>::infinity();
  Eigen::Index nearest = 0;
  double outward = 1.0;  // direction of the nearest face's normal, if inside
  for (Eigen::Index axis = 0; axis < x.rows(); ++axis) {
    const double below = x(axis, i) - obstacle.lower[axis];
    const double above = obstacle.upper[axis] - x(axis, i);
    const double gap = std::max({-below, -above, 0.0});
    squared += gap * gap;
    if (std::min(below, above) < depth) {
      depth = std::min(below, above);
      nearest = axis;
      outward = below < above ? -1.0 : 1.0;
    }
  }
  if (squared == 0.0) {
    const HingeValue value = hinge(-depth, penalty.length);
    adjoint(nearest, i) += weight * value.slope * outward;
    return weight * value.value;
  }
  const double distance = std::sqrt(squared);
  const HingeValue value = hinge(distance, penalty.length);
  if (value.slope == 0.0) return 0.0;
  for (Eigen::Index axis = 0; axis < x.rows(); ++axis) {
    const double beyond = std::max(x(axis, i) - obstacle.upper[axis], 0.0) -
                          std::max(obstacle.lower[axis] - x(axis, i), 0.0);
    adjoint(axis, i) += weight * value.slope * beyond / distance;
  }
  return weight * value.value;
}

/// Σ_axes of how far x_i lies outside `box` (Eq. 4-10), and the sign of each axis's part.
double outside(const Points& x, Eigen::Index i, const Box& box, Eigen::VectorXd& sign) {
  double sum = 0.0;
  for (Eigen::Index axis = 0; axis < x.rows(); ++axis) {
    const double below = std::max(box.lower[axis] - x(axis, i), 0.0);
    const double above = std::max(x(axis, i) - box.upper[axis], 0.0);
    sum += below + above;
    sign[axis] = above > 0.0 ? 1.0 : (below > 0.0 ? -1.0 : 0.0);
  }
  return sum;
}

/// Algorithm 2: the largest of the soft indicators max(0, 1 − d) of all obstacles.
double thesis_obstacles(const Points& x, Eigen::Index i, const SafeSet& safe_set, double weight,
                        Points& adjoint, Eigen::VectorXd& sign) {
  double largest = 0.0;
  const Box* at = nullptr;
  for (const Box& obstacle : safe_set.obstacles) {
    const double indicator = 1.0 - std::min(outside(x, i, obstacle, sign), 1.0);
    if (indicator > largest) {
      largest = indicator;
      at = &obstacle;
    }
  }
  if (at != nullptr) {
    outside(x, i, *at, sign);
    adjoint.col(i) -= weight * sign;
  }
  return weight * largest;
}

}  // namespace

PenaltyValue add_penalty(const Points& locations, const Eigen::VectorXd& weights,
                         const SafeSet& safe_set, const Penalty& penalty, Points& adjoint) {
  PenaltyValue total;
  Eigen::VectorXd sign(locations.rows());
  for (Eigen::Index i = 0; i < locations.cols(); ++i) {
    const double box_weight = penalty.box * weights[i];
    const double obstacle_weight = penalty.obstacle * weights[i];
    if (penalty.shape == PenaltyShape::kThesis) {
      total.box += box_weight * outside(locations, i, safe_set.bounds, sign);
      adjoint.col(i) += box_weight * sign;
      total.obstacle += thesis_obstacles(locations, i, safe_set, obstacle_weight, adjoint, sign);
    } else {
      total.box += smooth_box(locations, i, safe_set.bounds, penalty, box_weight, adjoint);
      for (const Box& obstacle : safe_set.obstacles) {
        total.obstacle +=
            smooth_obstacle(locations, i, obstacle, penalty, obstacle_weight, adjoint);
      }
    }
  }
  return total;
}

}  // namespace qsmpc
