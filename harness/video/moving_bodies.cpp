#include "harness/video/moving_bodies.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "harness/trace/seen_forecasts.hpp"
#include "harness/video/belief_shape.hpp"
#include "harness/video/episode_world.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kMostStages = 5;         // most stages drawn as an ellipse
constexpr double kLeastWeight = 0.01;  // least weight of a drawn way

render::PlanarPoint moved(const render::PlanarPoint& point, const Eigen::Vector2d& centre,
                          const Eigen::Rotation2Dd& turn, const Eigen::Vector2d& offset) {
  const Eigen::Vector2d at = centre + offset + turn * (Eigen::Vector2d(point.x, point.y) - centre);
  return {at.x(), at.y()};
}

// One way of an obstacle whose centre is at `centre` in the scenario.
render::ForecastWay way_of(const controller::PlacesByStage& stages, std::size_t way,
                           const Eigen::Vector2d& centre) {
  render::ForecastWay drawn{.weight = stages.front()[way].weight, .way = {}, .ellipses = {}};
  for (const std::vector<controller::ObstaclePlace>& places : stages) {
    const controller::ObstaclePlace& place = places[way];
    const Eigen::Vector2d mean = centre + place.offset;
    drawn.way.push_back({mean.x(), mean.y()});
    drawn.ellipses.push_back(
        deviation_ellipse({.mean = mean, .covariance = place.covariance}, kForecastDeviations));
  }
  return drawn;
}

}  // namespace

MovingBodies::MovingBodies(const EpisodeView& view)
    : driven_(view.trace()), forecasts_(view.trace().steps.size()) {
  for (std::size_t n = 0; n < driven_.count(); ++n) {
    bodies_.push_back({.prism = prism_of(driven_.shape(n)),
                       .centre = controller::shape_centre(driven_.shape(n))});
  }
  const int horizon = view.parts().stages;
  if (bodies_.empty() || horizon < 1) return;
  const std::vector<KnownForecasts> known =
      seen_forecasts(view.trace(), spread_stages(horizon, kMostStages));
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (view.trace().steps[k].plan_states.cols() == 0) continue;
    for (std::size_t n = 0; n < known[k].size(); ++n) {
      const std::vector<controller::ObstaclePlace>& now = known[k][n].front();
      for (std::size_t way = 0; way < now.size(); ++way) {
        if (now[way].weight < kLeastWeight) continue;
        forecasts_[k].push_back(way_of(known[k][n], way, bodies_[n].centre));
      }
    }
  }
}

std::vector<render::Prism> MovingBodies::at(double time) const {
  const Eigen::Matrix3Xd poses = driven_.poses_at(time);
  std::vector<render::Prism> prisms;
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const auto pose = poses.col(static_cast<Eigen::Index>(n));
    const Eigen::Rotation2Dd turn(pose[2]);
    render::Prism prism = bodies_[n].prism;
    const auto put = [&](std::vector<render::PlanarPoint>& points) {
      for (render::PlanarPoint& point : points) {
        point = moved(point, bodies_[n].centre, turn, pose.head<2>());
      }
    };
    put(prism.outline);
    for (std::vector<render::PlanarPoint>& piece : prism.pieces) put(piece);
    prisms.push_back(std::move(prism));
  }
  return prisms;
}

}  // namespace qsmpc::harness
