// The static parts of an episode's scenario in its pictures, and the clearances of points in the
// plane.
#pragma once

#include <vector>

#include "controller/regions/unsafe_set.hpp"
#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// Bounds, road, static obstacles and target of the scenario, as far as they lie in the plane of
/// position.
[[nodiscard]] render::World episode_world(const EpisodeView& view);

/// The drawn form of a shape in the plane.
[[nodiscard]] render::Prism prism_of(const controller::PlanarShape& shape);

/// Distances of points in the plane to the unsafe set, at times of the drive.
class PlanarClearances {
 public:
  /// `world` is episode_world(view), and `others` are the moving obstacles of its trace.
  PlanarClearances(const EpisodeView& view, const render::World& world,
                   const DrivenObstacles& others);

  /// Clearance of each of `points` at its time (s, as many as points), m, as clearance() gives for
  /// a point vehicle.
  [[nodiscard]] std::vector<double> of(const std::vector<render::PlanarPoint>& points,
                                       const std::vector<double>& times) const;

 private:
  controller::UnsafeSet standing_;
  controller::SafeSet moving_;  // only the moving obstacles
  DrivenObstacles others_;
};

}  // namespace qsmpc::harness
