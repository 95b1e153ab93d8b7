// What of an episode's scenario stands in its pictures, and how far the plane's points are from
// what is unsafe there.
#pragma once

#include <vector>

#include "controller/regions/unsafe_set.hpp"
#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// Bounds, road, obstacles that do not move and target of the scenario, as far as they lie in the
/// plane of position.
[[nodiscard]] render::World episode_world(const EpisodeView& view);

/// A shape of the plane as it is drawn.
[[nodiscard]] render::Prism prism_of(const controller::PlanarShape& shape);

/// How far points of the plane are from what is unsafe, at times of the drive.
class PlanarClearances {
 public:
  /// `world` is episode_world(view), and `others` are the obstacles of its trace that move.
  PlanarClearances(const EpisodeView& view, const render::World& world,
                   const DrivenObstacles& others);

  /// m, of each of `points` at its time (s, as many as points), as clearance() has it of a vehicle
  /// that is a point.
  [[nodiscard]] std::vector<double> of(const std::vector<render::PlanarPoint>& points,
                                       const std::vector<double>& times) const;

 private:
  controller::UnsafeSet standing_;
  controller::SafeSet moving_;  // nothing but what moves
  DrivenObstacles others_;
};

}  // namespace qsmpc::harness
