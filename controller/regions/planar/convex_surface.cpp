#include "controller/regions/planar/convex_surface.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

constexpr int kNewtonSteps = 6;
// After a turn by this or less, the next Newton step would change nothing.
constexpr double kNoTurn = 1e-8;
// A shorter vector has no direction.
constexpr double kNoLength = 1e-300;

/// The face that the point is farthest beyond or, inside, nearest to. The part must have a face.
Eigen::Index farthest_face(const ConvexPart& part, const Eigen::Vector2d& point) {
  Eigen::Index farthest = 0;
  double most = -kInfinity;
  for (Eigen::Index i = 0; i < part.normals.cols(); ++i) {
    const double distance = part.normals.col(i).dot(point) - part.offsets[i];
    if (distance <= most) continue;
    most = distance;
    farthest = i;
  }
  return farthest;
}

/// From the edge of face i to a point.
Eigen::Vector2d gap_to_edge(const ConvexPart& part, Eigen::Index i, const Eigen::Vector2d& point) {
  const Eigen::Vector2d from = part.corners.col(i);
  const Eigen::Vector2d along = part.corners.col((i + 1) % part.corners.cols()) - from;
  const double share = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return point - from - share * along;
}

/// The polygon without its radius, from outside. Along the edges visible from the point the
/// distance falls to a minimum and rises again; `face` is one of these edges.
SurfacePoint nearest_on_edges(const ConvexPart& part, Eigen::Index face,
                              const Eigen::Vector2d& point) {
  const Eigen::Index count = part.corners.cols();
  Eigen::Vector2d gap = gap_to_edge(part, face, point);
  double square = gap.squaredNorm();
  for (const Eigen::Index step : {Eigen::Index{1}, count - 1}) {
    Eigen::Index at = face;
    for (Eigen::Index k = 1; k < count; ++k) {
      at = (at + step) % count;
      const Eigen::Vector2d next = gap_to_edge(part, at, point);
      // Equal if both are nearest at their common corner.
      if (next.squaredNorm() > square) break;
      gap = next;
      square = gap.squaredNorm();
    }
  }
  SurfacePoint nearest{.distance = std::sqrt(square), .outward = part.normals.col(face)};
  if (nearest.distance > kNoLength) nearest.outward = gap / nearest.distance;
  return nearest;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double value_along(const Eigen::Vector2d& direction, const Eigen::Vector2d& gap, double radius,
                   const Eigen::Matrix2d& covariance) {
  return (direction.dot(gap) - radius) / std::sqrt(direction.dot(covariance * direction));
}

/// Has the sign of the derivative of (n·gap − radius)/√(nᵀSn) as n turns left.
double rise(const Eigen::Vector2d& n, const Eigen::Vector2d& gap, double radius,
            const Eigen::Matrix2d& covariance) {
  const Eigen::Vector2d t(-n.y(), n.x());
  const Eigen::Vector2d spread = covariance * n;
  return t.dot(gap) * n.dot(spread) - (n.dot(gap) - radius) * t.dot(spread);
}

/// The unit vector n, from one nearby, that maximises (n·gap − radius)/√(nᵀSn), by Newton steps on
/// the derivative by its angle; steps that do not raise the value are shortened.
Eigen::Vector2d best_direction(const Eigen::Vector2d& gap, double radius,
                               const Eigen::Matrix2d& covariance, Eigen::Vector2d n) {
  double value = value_along(n, gap, radius, covariance);
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Eigen::Vector2d t(-n.y(), n.x());
    const Eigen::Vector2d spread = covariance * n;
    // f = a/√q with a = n·gap − radius, q = nᵀSn; the sign of f' is that of g = a' q − a q'/2.
    const double along = n.dot(gap);
    const double a = along - radius;
    const double a1 = t.dot(gap);
    const double q = n.dot(spread);
    const double q1 = 2.0 * t.dot(spread);
    const double q2 = 2.0 * (t.dot(covariance * t) - q);
    const double g = a1 * q - 0.5 * a * q1;
    const double g1 = -along * q + 0.5 * a1 * q1 - 0.5 * a * q2;
    double move = g1 < 0.0 ? -g / g1 : (g > 0.0 ? 0.5 : -0.5);
    move = std::clamp(move, -0.7, 0.7);
    // A turn by the angle whose tangent is `move`: the derivatives at 0 are the same.
    if (std::abs(move) <= kNoTurn) return (n + move * t).normalized();
    bool raised = false;
    for (int half = 0; half < 5 && !raised; ++half, move *= 0.5) {
      const Eigen::Vector2d turned = (n + move * t).normalized();
      const double at = value_along(turned, gap, radius, covariance);
      if (!(at > value)) continue;
      raised = true;
      value = at;
      n = turned;
    }
    if (!raised) break;
  }
  return n;
}

void take(const Eigen::Vector2d& direction, double z, const Eigen::Matrix2d& covariance,
          PlanarSeparation& best) {
  if (z <= best.z) return;
  best.z = z;
  best.slope = direction / std::sqrt(direction.dot(covariance * direction));
}

}  // namespace

SurfacePoint nearest_surface(const ConvexPart& part, const Eigen::Vector2d& point) {
  SurfacePoint nearest;
  if (part.normals.cols() == 0) {
    const Eigen::Vector2d gap = point - part.corners.col(0);
    nearest.distance = gap.norm();
    if (nearest.distance > kNoLength) nearest.outward = gap / nearest.distance;
  } else {
    const Eigen::Index face = farthest_face(part, point);
    nearest = {.distance = part.normals.col(face).dot(point) - part.offsets[face],
               .outward = part.normals.col(face)};
    if (nearest.distance > 0.0 && part.corners.cols() > 0) {
      nearest = nearest_on_edges(part, face, point);
    }
  }
  nearest.distance -= part.radius;
  return nearest;
}

SurfacePoint nearest_surface(std::span<const ConvexPart> parts, const Eigen::Vector2d& point) {
  SurfacePoint nearest = nearest_surface(parts.front(), point);
  for (const ConvexPart& part : parts.subspan(1)) {
    const SurfacePoint other = nearest_surface(part, point);
    if (other.distance < nearest.distance) nearest = other;
  }
  return nearest;
}

double support(const ConvexPart& part, const Eigen::Vector2d& direction) {
  if (part.corners.cols() > 0) {
    return (direction.transpose() * part.corners).maxCoeff() + part.radius * direction.norm();
  }
  // A half-plane is bounded only in the direction of its normal.
  const Eigen::Vector2d normal = part.normals.col(0);
  const double along = direction.dot(normal);
  // Exactly 0 for the normal itself, whose length is 1 up to rounding.
  const double across = direction.x() * normal.y() - direction.y() * normal.x();
  const bool is_normal = along > 0.0 && across == 0.0;
  return is_normal ? along * (part.offsets[0] + part.radius) : kInfinity;
}

Circle circle_about(const ConvexPart& part) {
  if (part.corners.cols() == 0) return {.radius = kInfinity};
  const Eigen::Vector2d centre =
      0.5 * (part.corners.rowwise().minCoeff() + part.corners.rowwise().maxCoeff());
  const double reach = (part.corners.colwise() - centre).colwise().norm().maxCoeff();
  return {.centre = centre, .radius = reach + part.radius};
}

PlanarSeparation separation(const ConvexPart& part, const Eigen::Vector2d& mean,
                            const Eigen::Matrix2d& covariance) {
  PlanarSeparation best{.z = -kInfinity, .slope = Eigen::Vector2d::Zero()};
  const Eigen::Index faces = part.normals.cols();
  for (Eigen::Index i = 0; i < faces; ++i) {
    const Eigen::Vector2d normal = part.normals.col(i);
    const double deviation = std::sqrt(normal.dot(covariance * normal));
    take(normal, (normal.dot(mean) - part.offsets[i] - part.radius) / deviation, covariance, best);
  }
  const Eigen::Matrix2d inverse = covariance.inverse();
  for (Eigen::Index i = 0; i < part.corners.cols(); ++i) {
    const Eigen::Vector2d gap = mean - part.corners.col(i);
    Eigen::Vector2d before = Eigen::Vector2d::Zero();
    Eigen::Vector2d after = Eigen::Vector2d::Zero();
    if (faces > 0) {
      before = part.normals.col((i + faces - 1) % faces);
      after = part.normals.col(i);
    }
    // At a corner n turns from one face's normal to the next one's; if the maximum is not between
    // them, a face is better.
    if (faces > 0 && (rise(before, gap, part.radius, covariance) < 0.0 ||
                      rise(after, gap, part.radius, covariance) > 0.0)) {
      continue;
    }
    const auto between = [&](const Eigen::Vector2d& n) {
      return faces == 0 || (cross(before, n) >= 0.0 && cross(n, after) >= 0.0);
    };
    Eigen::Vector2d n = (inverse * gap).normalized();  // the maximum for a radius of 0
    if (!between(n)) n = (before + after).normalized();
    if (part.radius > 0.0) {
      if (n.isZero(0.0)) n = Eigen::Vector2d::UnitX();  // about the centre of a disc, any will do
      n = best_direction(gap, part.radius, covariance, n);
    }
    if (n.allFinite() && between(n)) {
      take(n, value_along(n, gap, part.radius, covariance), covariance, best);
    }
  }
  return best;
}

}  // namespace qsmpc::controller
