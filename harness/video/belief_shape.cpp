#include "harness/video/belief_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kHalf = 0.50;
constexpr double kMost = 0.95;

// Radius of the circle that contains `probability` of the standard Gaussian in the plane.
double planar_quantile(double probability) { return std::sqrt(-2.0 * std::log1p(-probability)); }

render::PlanarPoint point_of(const Eigen::Vector2d& vector) { return {vector.x(), vector.y()}; }

// Direction of the path at stage `i`, from its neighbours; along x if it does not move.
Eigen::Vector2d direction_at(const std::vector<PlanarMoments>& stages, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : 0;
  const std::size_t after = std::min(i + 1, stages.size() - 1);
  const Eigen::Vector2d way = stages[after].mean - stages[before].mean;
  return way.norm() > 0.0 ? Eigen::Vector2d(way.normalized()) : Eigen::Vector2d::UnitX();
}

// The point of the 95 % ellipse that lies farthest in the direction `normal`, which has length 1;
// its tangent there is perpendicular to `normal`.
Eigen::Vector2d farthest(const PlanarMoments& stage, const Eigen::Vector2d& normal) {
  const Eigen::Vector2d pull = stage.covariance * normal;
  const double deviation = std::sqrt(std::max(normal.dot(pull), 0.0));
  if (!(deviation > 0.0)) return stage.mean;
  return stage.mean + planar_quantile(kMost) / deviation * pull;
}

// A section of the tube, whose direction is `along`, or of its round end: `turn` goes from 0 at the
// widest section to a right angle at the tip.
render::TubeSection section_of(const PlanarMoments& stage, const Eigen::Vector2d& along,
                               double turn, double bound) {
  const Eigen::Vector2d left(-along.y(), along.x());
  const Eigen::Vector2d ahead = std::sin(turn) * along;
  return {.left = point_of(farthest(stage, ahead + std::cos(turn) * left)),
          .right = point_of(farthest(stage, ahead - std::cos(turn) * left)),
          .bound = bound};
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

render::PlanarEllipse deviation_ellipse(const PlanarMoments& moments, double deviations) {
  const models::SymmetricEigen axes = models::symmetric_eigen(moments.covariance);
  const auto axis = [&](Eigen::Index i) {
    const double deviation = std::sqrt(std::max(axes.values[i], 0.0));
    return point_of(deviations * deviation * axes.vectors.col(i));
  };
  return {.centre = point_of(moments.mean), .first_axis = axis(1), .second_axis = axis(0)};
}

render::PlanarEllipse probability_ellipse(const PlanarMoments& moments, double probability) {
  return deviation_ellipse(moments, planar_quantile(probability));
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
  if (stages.empty() || bounds.empty() || bounds.size() + 1 < stages.size()) return tube;
  constexpr double kRight = 0.5 * std::numbers::pi;
  const auto turned = [](int step) { return kRight * step / kTubeEndSections; };
  for (int step = kTubeEndSections; step > 0; --step) {
    tube.push_back(section_of(stages.front(), direction_at(stages, 0), -turned(step), bounds[0]));
  }
  for (std::size_t i = 0; i < stages.size(); ++i) {
    tube.push_back(section_of(stages[i], direction_at(stages, i), 0.0, bounds[i > 0 ? i - 1 : 0]));
  }
  const std::size_t last = stages.size() - 1;
  for (int step = 1; step <= kTubeEndSections; ++step) {
    tube.push_back(
        section_of(stages[last], direction_at(stages, last), turned(step), tube.back().bound));
  }
  return tube;
}

}  // namespace qsmpc::harness
