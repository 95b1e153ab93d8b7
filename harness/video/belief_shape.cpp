#include "harness/video/belief_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kHalf = 0.50;
constexpr double kMost = 0.95;

// Radius of the circle that holds `probability` of the standard Gaussian in the plane.
double planar_quantile(double probability) { return std::sqrt(-2.0 * std::log1p(-probability)); }

render::PlanarPoint point_of(const Eigen::Vector2d& vector) { return {vector.x(), vector.y()}; }

// The way's direction at stage `i`, from its neighbours; along x where it stands still.
Eigen::Vector2d direction_at(const std::vector<PlanarMoments>& stages, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : 0;
  const std::size_t after = std::min(i + 1, stages.size() - 1);
  const Eigen::Vector2d way = stages[after].mean - stages[before].mean;
  return way.norm() > 0.0 ? Eigen::Vector2d(way.normalized()) : Eigen::Vector2d::UnitX();
}

}  // namespace

PlanarMoments planar_moments(const render::ParticleStage& stage) {
  PlanarMoments moments;
  for (std::size_t i = 0; i < stage.points.size(); ++i) {
    moments.mean += stage.weights[i] * Eigen::Vector2d(stage.points[i].x, stage.points[i].y);
  }
  for (std::size_t i = 0; i < stage.points.size(); ++i) {
    const Eigen::Vector2d offset =
        Eigen::Vector2d(stage.points[i].x, stage.points[i].y) - moments.mean;
    moments.covariance += stage.weights[i] * offset * offset.transpose();
  }
  return moments;
}

render::PlanarEllipse probability_ellipse(const PlanarMoments& moments, double probability) {
  const models::SymmetricEigen axes = models::symmetric_eigen(moments.covariance);
  const double radius = planar_quantile(probability);
  const auto axis = [&](Eigen::Index i) {
    const double deviation = std::sqrt(std::max(axes.values[i], 0.0));
    return point_of(radius * deviation * axes.vectors.col(i));
  };
  return {.centre = point_of(moments.mean), .first_axis = axis(1), .second_axis = axis(0)};
}

std::vector<render::BeliefEllipses> belief_ellipses(const std::vector<PlanarMoments>& stages) {
  std::vector<render::BeliefEllipses> ellipses;
  ellipses.reserve(stages.size());
  for (const PlanarMoments& stage : stages) {
    ellipses.push_back(
        {.half = probability_ellipse(stage, kHalf), .most = probability_ellipse(stage, kMost)});
  }
  return ellipses;
}

std::vector<render::TubeSection> belief_tube(const std::vector<PlanarMoments>& stages,
                                             const std::vector<double>& bounds) {
  std::vector<render::TubeSection> tube;
  if (bounds.empty() || bounds.size() + 1 < stages.size()) return tube;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const Eigen::Vector2d along = direction_at(stages, i);
    const Eigen::Vector2d left(-along.y(), along.x());
    // The farthest that the ellipse of 95 % reaches across the way.
    const double half_width =
        planar_quantile(kMost) * std::sqrt(std::max(left.dot(stages[i].covariance * left), 0.0));
    tube.push_back({.left = point_of(stages[i].mean + half_width * left),
                    .right = point_of(stages[i].mean - half_width * left),
                    .bound = bounds[i > 0 ? i - 1 : 0]});
  }
  return tube;
}

}  // namespace qsmpc::harness
