#include "tests/support/shape_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include <Eigen/Geometry>

namespace qsmpc::testing {
namespace {

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - share * (b - a)).norm();
}

struct Nearness {
  Eigen::Vector2d point;
  double reach;

  bool operator()(const controller::DiscShape& disc) const {
    return (point - disc.centre).norm() <= disc.radius + reach;
  }
  bool operator()(const controller::TurnedBoxShape& box) const {
    const Eigen::Vector2d at = Eigen::Rotation2Dd(-box.angle) * (point - box.centre);
    return (at.cwiseAbs() - 0.5 * box.size).cwiseMax(0.0).norm() <= reach;
  }
  bool operator()(const controller::EllipseShape& ellipse) const {
    const Eigen::Vector2d at = Eigen::Rotation2Dd(-ellipse.angle) * (point - ellipse.centre);
    if (at.cwiseQuotient(ellipse.semi_axes).squaredNorm() <= 1.0) return true;
    if (reach == 0.0 || at.norm() > ellipse.semi_axes.maxCoeff() + reach) return false;
    const auto distance = [&](double angle) {
      return (at -
              ellipse.semi_axes.cwiseProduct(Eigen::Vector2d(std::cos(angle), std::sin(angle))))
          .norm();
    };
    // There is one minimum in the quadrant of the point.
    double low = 0.0;
    double high = 0.5 * std::numbers::pi;
    const auto mirrored = [&](double angle) {
      return std::atan2(std::copysign(std::sin(angle), at.y()),
                        std::copysign(std::cos(angle), at.x()));
    };
    for (int step = 0; step < 36; ++step) {
      const double third = (high - low) / 3.0;
      if (distance(mirrored(low + third)) < distance(mirrored(high - third))) {
        high -= third;
      } else {
        low += third;
      }
    }
    return distance(mirrored(0.5 * (low + high))) <= reach;
  }
  bool operator()(const controller::PolygonShape& polygon) const {
    // Parity of the crossings of a ray to the right.
    bool inside = false;
    double least = std::numeric_limits<double>::infinity();
    const Eigen::Index count = polygon.corners.cols();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector2d a = polygon.corners.col(i);
      const Eigen::Vector2d b = polygon.corners.col((i + 1) % count);
      least = std::min(least, distance_to_segment(point, a, b));
      if ((a.y() > point.y()) == (b.y() > point.y())) continue;
      const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (point.x() < x) inside = !inside;
    }
    return inside || least <= reach;
  }
  bool operator()(const controller::HalfPlaneShape& half_plane) const {
    return half_plane.normal.dot(point) + reach * half_plane.normal.norm() >= half_plane.offset;
  }
};

}  // namespace

bool is_near(const controller::PlanarShape& shape, const Eigen::Vector2d& point, double reach) {
  return std::visit(Nearness{.point = point, .reach = reach}, shape);
}

}  // namespace qsmpc::testing
