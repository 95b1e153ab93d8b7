// The moving obstacles in pictures of an episode: their true poses, and the planner's forecasts of
// them.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// Size of an ellipse around an obstacle's centre, in standard deviations.
inline constexpr double kForecastDeviations = 2.0;

/// Const functions may be called from several threads concurrently.
class MovingBodies {
 public:
  /// Copies what it needs from `view`.
  explicit MovingBodies(const EpisodeView& view);

  [[nodiscard]] const DrivenObstacles& driven() const { return driven_; }

  /// The drawn obstacles at `time` (s).
  [[nodiscard]] std::vector<render::Prism> at(double time) const;

  /// The forecasts used by the plan of period `step`: each way that an obstacle may intend to take,
  /// unless it is very unlikely. Empty if nothing was planned.
  [[nodiscard]] const std::vector<render::ForecastWay>& forecasts(std::size_t step) const {
    return forecasts_[step];
  }

 private:
  struct Body {
    render::Prism prism;  // as placed by the scenario
    Eigen::Vector2d centre;
  };

  DrivenObstacles driven_;
  std::vector<Body> bodies_;
  std::vector<std::vector<render::ForecastWay>> forecasts_;  // one entry per period
};

}  // namespace qsmpc::harness
