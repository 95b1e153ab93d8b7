// The safe set of a drive with the obstacles that move where they truly were.
//
//   const controller::UnsafeSet unsafe(driven_safe_set(trace));
//   controller::clearance(states.col(k), unsafe, k);
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// A forecast that knows where obstacles are: `poses` (offset x, y in m and turn in rad, 3 x count)
/// of each stage, at least one.
[[nodiscard]] std::shared_ptr<controller::ObstacleForecast> known_places(
    const std::vector<Eigen::Matrix3Xd>& poses);

/// Stages of its regions are the control instants of the trace. Obstacles are as DrivenObstacles
/// has them.
[[nodiscard]] controller::SafeSet driven_safe_set(const Trace& trace);

}  // namespace qsmpc::harness
