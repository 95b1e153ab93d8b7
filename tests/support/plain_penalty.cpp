#include "tests/support/plain_penalty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qsmpc::testing {
namespace {

struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// h of penalty.hpp.
ValueAndSlope hinge(double distance, double length) {
  const double ratio = distance / length;
  if (ratio >= 1.0) return {};
  if (ratio >= 0.0) return {0.5 * (1.0 - ratio) * (1.0 - ratio), -(1.0 - ratio) / length};
  return {0.5 - ratio, -1.0 / length};
}

/// E(m + s z)²₊ for standard normal z, and half its derivative.
ValueAndSlope squared_hinge(double m, double s) {
  const double inside = 0.5 * std::erfc(-m / s / std::sqrt(2.0));
  const double density = std::exp(-0.5 * m * m / (s * s)) / std::sqrt(2.0 * M_PI);
  return {(m * m + s * s) * inside + m * s * density, m * inside + s * density};
}

/// Derivatives by the distance and by the deviation.
struct ExpectedHinge {
  double value = 0.0;
  double slope = 0.0;
  double deviation_slope = 0.0;
};

/// E h(distance + n) for normal noise n: h is ½ t²₊ − ½ (t − 1)²₊ with t = 1 − distance/length.
ExpectedHinge expected_hinge(double distance, double deviation, double length) {
  if (deviation == 0.0) {
    const ValueAndSlope plain = hinge(distance, length);
    return {plain.value, plain.slope, 0.0};
  }
  if (std::isinf(distance)) return {};
  const double t = 1.0 - distance / length;
  const double s = deviation / length;
  const ValueAndSlope whole = squared_hinge(t, s);
  const ValueAndSlope beyond = squared_hinge(t - 1.0, s);
  // d/ds ½ E(t + s z)²₊ = E z (t + s z)₊ = s P(t + s z > 0), by Stein's identity.
  const double between =
      0.5 * (std::erfc(-t / s / std::sqrt(2.0)) - std::erfc(-(t - 1.0) / s / std::sqrt(2.0)));
  return {0.5 * (whole.value - beyond.value), (beyond.slope - whole.slope) / length,
          s * between / length};
}

bool bounded(const controller::Box& box, Eigen::Index axis) {
  return std::isfinite(box.lower[axis]) || std::isfinite(box.upper[axis]);
}

/// Signed distance to the box, negative inside; `outward` is its gradient.
double outward_distance(const Eigen::VectorXd& x, const controller::Box& box,
                        Eigen::VectorXd& outward) {
  const Eigen::VectorXd nearest = x.cwiseMax(box.lower).cwiseMin(box.upper);
  const double distance = (x - nearest).norm();
  if (distance > 0.0) {
    outward = (x - nearest) / distance;
    return distance;
  }
  double depth = std::numeric_limits<double>::infinity();
  for (Eigen::Index axis = 0; axis < x.size(); ++axis) {
    const double below = x[axis] - box.lower[axis];
    const double above = box.upper[axis] - x[axis];
    if (std::min(below, above) >= depth) continue;
    depth = std::min(below, above);
    outward.setZero();
    outward[axis] = below < above ? -1.0 : 1.0;
  }
  return -depth;
}

/// How far x is outside an interval (Eq. 4-10).
ValueAndSlope excess(double x, double lower, double upper) {
  if (x > upper) return {x - upper, 1.0};
  if (x < lower) return {lower - x, -1.0};
  return {};
}

}  // namespace

PenaltyValue PlainPenalty::operator()(const Eigen::VectorXd& x, Eigen::VectorXd& slope) const {
  return penalty_.shape == controller::PenaltyShape::kThesis ? thesis(x, slope) : smooth(x, slope);
}

double PlainPenalty::of_bounds(const Eigen::MatrixXd& x, const Eigen::VectorXd& weights,
                               const Eigen::VectorXd& deviations, Eigen::MatrixXd& slopes,
                               Eigen::VectorXd& deviation_slopes) const {
  double value = 0.0;
  slopes.setZero(x.rows(), x.cols());
  deviation_slopes.setZero(x.rows());
  if (penalty_.shape == controller::PenaltyShape::kThesis) return value;
  const controller::Box& room = safe_set_.bounds;
  for (Eigen::Index axis = 0; axis < x.rows(); ++axis) {
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      for (const double side : {1.0, -1.0}) {
        const double distance =
            side > 0.0 ? x(axis, i) - room.lower[axis] : room.upper[axis] - x(axis, i);
        const ExpectedHinge h = expected_hinge(distance, deviations[axis], penalty_.length);
        const double weight = penalty_.box * weights[i];
        value += weight * h.value;
        slopes(axis, i) += side * weight * h.slope;
        deviation_slopes[axis] += weight * h.deviation_slope;
      }
    }
  }
  return value;
}

PenaltyValue PlainPenalty::smooth(const Eigen::VectorXd& x, Eigen::VectorXd& slope) const {
  PenaltyValue value;
  for (const controller::Obstacle& each : safe_set_.obstacles) {
    const controller::Box& obstacle = *each.box();
    Eigen::VectorXd outward = Eigen::VectorXd::Zero(x.size());
    const double distance = outward_distance(x, obstacle, outward);
    const ValueAndSlope h = hinge(distance, penalty_.length);
    value.obstacle += penalty_.obstacle * h.value;
    slope += penalty_.obstacle * h.slope * outward;
  }
  return value;
}

PenaltyValue PlainPenalty::thesis(const Eigen::VectorXd& x, Eigen::VectorXd& slope) const {
  PenaltyValue value;
  const controller::Box& room = safe_set_.bounds;
  for (Eigen::Index axis = 0; axis < x.size(); ++axis) {
    const ValueAndSlope out = excess(x[axis], room.lower[axis], room.upper[axis]);
    value.box += penalty_.box * out.value;
    slope[axis] += penalty_.box * out.slope;
  }
  double largest = 0.0;
  Eigen::VectorXd of_largest = Eigen::VectorXd::Zero(x.size());
  for (const controller::Obstacle& each : safe_set_.obstacles) {
    const controller::Box& obstacle = *each.box();
    double outside = 0.0;
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(x.size());
    for (Eigen::Index axis = 0; axis < x.size(); ++axis) {
      if (!bounded(obstacle, axis)) continue;
      const ValueAndSlope out = excess(x[axis], obstacle.lower[axis], obstacle.upper[axis]);
      outside += out.value;
      direction[axis] = -out.slope;
    }
    if (1.0 - std::min(outside, 1.0) <= largest) continue;
    largest = 1.0 - std::min(outside, 1.0);
    of_largest = direction;
  }
  value.obstacle = penalty_.obstacle * largest;
  slope += penalty_.obstacle * of_largest;
  return value;
}

}  // namespace qsmpc::testing
