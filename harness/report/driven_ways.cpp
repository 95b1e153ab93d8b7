#include "harness/report/driven_ways.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "controller/regions/standing.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/trace/true_places.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

MapPolygon polygon_of(const controller::PlanarShape& shape) {
  const Eigen::Matrix2Xd corners = controller::shape_outline(shape);
  MapPolygon polygon;
  for (const auto& corner : corners.colwise()) {
    polygon.corners.push_back({.x = corner.x(), .y = corner.y()});
  }
  return polygon;
}

/// Only obstacle n, at its true poses; stages are the control instants.
controller::UnsafeSet alone(const controller::SafeSet& safe_set, const DrivenObstacles& others,
                            std::size_t n) {
  controller::SafeSet one = controller::unbounded_safe_set(safe_set.dim());
  one.body = safe_set.body;
  one.obstacles = {*controller::moving_obstacles(safe_set)[n]};
  std::vector<Eigen::Matrix3Xd> poses;
  for (const Eigen::Matrix3Xd& all : others.poses()) {
    poses.emplace_back(all.col(static_cast<Eigen::Index>(n)));
  }
  one.forecast = known_places(poses);
  return one;
}

/// The first control instant at which the vehicle was nearest to obstacle n.
std::size_t nearest_instant(const EpisodeView& view, const DrivenObstacles& others, std::size_t n) {
  const controller::UnsafeSet unsafe = alone(view.scenario().safe_set, others, n);
  const Eigen::MatrixXd& states = view.states();
  const auto instants = std::min(static_cast<std::size_t>(states.cols()), others.poses().size());
  std::size_t nearest = 0;
  double least = kInfinity;
  for (std::size_t k = 0; k < instants; ++k) {
    const auto stage = static_cast<Eigen::Index>(k);
    const double clearance = controller::clearance(states.col(stage), unsafe, stage);
    if (!(clearance < least)) continue;
    least = clearance;
    nearest = k;
  }
  return nearest;
}

}  // namespace

std::vector<MapMover> driven_ways(const EpisodeView& view, const DrivenObstacles& others) {
  std::vector<MapMover> movers;
  for (std::size_t n = 0; n < others.count(); ++n) {
    MapMover& mover = movers.emplace_back();
    const Eigen::Vector2d centre = controller::shape_centre(others.shape(n));
    for (const Eigen::Matrix3Xd& poses : others.poses()) {
      const Eigen::Vector2d at = centre + poses.col(static_cast<Eigen::Index>(n)).head<2>();
      mover.way.push_back({.x = at.x(), .y = at.y()});
    }
    const auto outline = [&](std::size_t k) {
      return polygon_of(others.shape_at(n, others.poses()[k]));
    };
    mover.start = outline(0);
    mover.end = outline(others.poses().size() - 1);
    mover.nearest = outline(nearest_instant(view, others, n));
  }
  return movers;
}

std::vector<MapMover> written_movers(const controller::SafeSet& safe_set) {
  std::vector<MapMover> movers;
  for (const controller::Obstacle* obstacle : controller::moving_obstacles(safe_set)) {
    movers.push_back({.start = polygon_of(*obstacle->shape())});
  }
  return movers;
}

Scenario standing_scenario(Scenario scenario) {
  scenario.safe_set = controller::standing(std::move(scenario.safe_set));
  return scenario;
}

}  // namespace qsmpc::harness
