// The obstacles that move, as pictures of an episode show them: where they truly are, and where the
// planner took them to be going.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// Standard deviations that an ellipse about an obstacle's middle reaches.
inline constexpr double kForecastDeviations = 2.0;

/// Const functions may be called from several threads at once.
class MovingBodies {
 public:
  /// Takes what it needs from `view`.
  explicit MovingBodies(const EpisodeView& view);

  [[nodiscard]] const DrivenObstacles& driven() const { return driven_; }

  /// At `time` (s).
  [[nodiscard]] std::vector<render::Prism> at(double time) const;

  /// As the plan of period `step` has it: each way that an obstacle may intend, unless it is hardly
  /// possible. None where nothing was planned.
  [[nodiscard]] const std::vector<render::ForecastWay>& forecasts(std::size_t step) const {
    return forecasts_[step];
  }

 private:
  struct Body {
    render::Prism prism;  // as it is written
    Eigen::Vector2d centre;
  };

  DrivenObstacles driven_;
  std::vector<Body> bodies_;
  std::vector<std::vector<render::ForecastWay>> forecasts_;  // of each period
};

}  // namespace qsmpc::harness
