#include "tests/support/simulated_truth.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "controller/prediction/policy.hpp"
#include "controller/regions/planar/road_walls.hpp"
#include "models/linear_algebra.hpp"
#include "tests/support/moving_truth.hpp"
#include "tests/support/shape_truth.hpp"

namespace qsmpc::testing {
namespace {

// Written out again here, so that the reference does not depend on the code under test.

/// The disc's centre (x, y) in state i; coordinates that the system lacks are 0.
Eigen::Vector2d centre_of(const controller::Body& body, const controller::Disc& disc,
                          const controller::Points& states, Eigen::Index i) {
  Eigen::Vector2d centre(body.x >= 0 ? states(body.x, i) : 0.0,
                         body.y >= 0 ? states(body.y, i) : 0.0);
  if (body.heading >= 0) {
    centre += Eigen::Rotation2Dd(states(body.heading, i)).toRotationMatrix() * disc.offset;
  }
  return centre;
}

/// Whether the box contains a point of the disc at the other coordinates of state i.
bool touches(const controller::Box& box, const controller::Body& body, const controller::Disc& disc,
             const controller::Points& states, Eigen::Index i) {
  const Eigen::Vector2d centre = centre_of(body, disc, states, i);
  double square = 0.0;
  for (Eigen::Index axis = 0; axis < states.rows(); ++axis) {
    const bool is_position = axis == body.x || axis == body.y;
    const double at = axis == body.x ? centre.x() : axis == body.y ? centre.y() : states(axis, i);
    const double outside = std::max({0.0, box.lower[axis] - at, at - box.upper[axis]});
    if (!is_position && outside > 0.0) return false;
    square += outside * outside;
  }
  return std::sqrt(square) <= disc.radius;
}

/// Whether the disc touches a wall of the road, each as a polygon.
bool touches(const controller::RoadWalls& road, const Eigen::Vector2d& centre, double radius) {
  return std::any_of(
      road.pieces().begin(), road.pieces().end(), [&](const controller::ConvexPart& piece) {
        const Eigen::Vector2d middle = piece.corners.rowwise().mean();
        const double reach =
            radius + (piece.corners.colwise() - middle).colwise().norm().maxCoeff();
        return (centre - middle).norm() <= reach &&
               is_near(controller::PolygonShape{.corners = piece.corners}, centre, radius);
      });
}

/// Whether the whole disc and the other coordinates of state i are within the bounds.
bool within(const controller::Box& bounds, const controller::Body& body,
            const controller::Disc& disc, const controller::Points& states, Eigen::Index i) {
  const Eigen::Vector2d centre = centre_of(body, disc, states, i);
  for (Eigen::Index axis = 0; axis < states.rows(); ++axis) {
    const bool is_position = axis == body.x || axis == body.y;
    const double at = axis == body.x ? centre.x() : axis == body.y ? centre.y() : states(axis, i);
    const double room = is_position ? disc.radius : 0.0;
    if (at - room < bounds.lower[axis] || at + room > bounds.upper[axis]) return false;
  }
  return true;
}

/// `point` in the unmoved frame of an obstacle that has moved as in run i.
Eigen::Vector2d as_seen_by(const controller::PlanarShape& shape, const MovingTruth& moved,
                           const Eigen::Vector2d& point, int i) {
  const Eigen::Vector2d centre = controller::shape_centre(shape);
  const Eigen::Vector2d arm = point - centre - moved.offset(i);
  const double turn = moved.turn(i);
  return centre + Eigen::Vector2d(std::cos(turn) * arm.x() + std::sin(turn) * arm.y(),
                                  std::cos(turn) * arm.y() - std::sin(turn) * arm.x());
}

/// One per obstacle; empty for one that stands still.
using Movements = std::vector<std::optional<MovingTruth>>;

Movements movements_of(const controller::SafeSet& safe_set, int paths, Generator& generator) {
  Movements movements;
  for (const controller::Obstacle& obstacle : safe_set.obstacles) {
    movements.emplace_back();
    if (obstacle.motion) {
      movements.back().emplace(*obstacle.motion, kObstaclePeriod, paths, generator);
    }
  }
  return movements;
}

bool unsafe(const controller::SafeSet& safe_set, const Movements& movements,
            const controller::Points& states, int i) {
  const controller::Body& body = safe_set.body;
  const std::vector<controller::Disc> point(1);
  for (const controller::Disc& disc : body.is_point() ? point : body.discs) {
    if (!within(safe_set.bounds, body, disc, states, i)) return true;
    if (safe_set.road && touches(*safe_set.road, centre_of(body, disc, states, i), disc.radius)) {
      return true;
    }
    for (std::size_t n = 0; n < safe_set.obstacles.size(); ++n) {
      const controller::Obstacle& obstacle = safe_set.obstacles[n];
      if (const controller::Box* box = obstacle.box()) {
        if (touches(*box, body, disc, states, i)) return true;
        continue;
      }
      Eigen::Vector2d centre = centre_of(body, disc, states, i);
      if (movements[n]) centre = as_seen_by(*obstacle.shape(), *movements[n], centre, i);
      if (is_near(*obstacle.shape(), centre, disc.radius)) return true;
    }
  }
  return false;
}

/// Draws of N(0, covariance), one per column; the covariance may be singular.
class NormalDraws {
 public:
  explicit NormalDraws(const Eigen::MatrixXd& covariance) {
    const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
    root_ = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  }
  [[nodiscard]] controller::Points operator()(Eigen::Index count, Generator& generator) {
    return root_ *
           controller::Points::NullaryExpr(root_.rows(), count, [&] { return normal_(generator); });
  }

 private:
  Eigen::MatrixXd root_;
  std::normal_distribution<double> normal_;
};

}  // namespace

UnsafeCounts simulate(const controller::PredictedMotion& motion,
                      const controller::SafeSet& safe_set, int paths, Generator& generator,
                      std::vector<controller::Points>* states, const PlantError& error) {
  NormalDraws belief(motion.belief.covariance);
  NormalDraws noise(motion.noise_covariance);
  controller::Points current = belief(paths, generator).colwise() + motion.belief.mean;
  controller::Points drawn = controller::Points::Zero(current.rows(), paths);
  if (error && motion.belief_error != nullptr) {
    current += error({.stage = -1, .stepped = current, .last_noise = drawn});
  }
  controller::Points inputs(motion.policy.inputs.rows(), paths);
  controller::Points next(current.rows(), paths);
  Movements movements = movements_of(safe_set, paths, generator);
  UnsafeCounts counts;
  std::vector<bool> ever(paths, false);
  for (Eigen::Index k = 0; k < motion.policy.horizon(); ++k) {
    controller::policy_inputs(motion.policy, k, current, inputs);
    motion.dynamics.step(current, inputs, next);
    if (error) next += error({.stage = k, .stepped = next, .last_noise = drawn});
    drawn = noise(paths, generator);
    current = next + drawn;
    for (auto& movement : movements) {
      if (movement) movement->advance(generator);
    }
    counts.stages.push_back(0);
    for (int i = 0; i < paths; ++i) {
      if (!unsafe(safe_set, movements, current, i)) continue;
      ++counts.stages.back();
      ever[i] = true;
    }
    if (states != nullptr) states->push_back(current);
  }
  counts.any = static_cast<int>(std::count(ever.begin(), ever.end(), true));
  return counts;
}

}  // namespace qsmpc::testing
