// The safe set of a drive with its moving obstacles at their true poses.
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

/// A forecast with known obstacle poses: `poses` of each stage (offset x, y in m and rotation in
/// rad, 3 x count), at least one stage.
[[nodiscard]] std::shared_ptr<controller::ObstacleForecast> known_places(
    const std::vector<Eigen::Matrix3Xd>& poses);

/// The stages of its regions are the control instants of the trace. Obstacles are posed as by
/// DrivenObstacles.
[[nodiscard]] controller::SafeSet driven_safe_set(const Trace& trace);

}  // namespace qsmpc::harness
