// What was known of the obstacles that move when each plan was made: worked out again from what was
// seen of them, for a trace holds only that.
//
//   const auto known = seen_forecasts(trace, {0, 5, 10});
//   known[k][n][1];   // the places at stage 5 of obstacle n, as known in period k
#pragma once

#include <vector>

#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// The forecast of each obstacle, for some stages.
using KnownForecasts = std::vector<controller::PlacesByStage>;

/// Stages 0 … `horizon` ≥ 0: at most `most` ≥ 2 of them, evenly spread, the first and the last
/// always.
[[nodiscard]] std::vector<int> spread_stages(int horizon, int most);

/// Of each period the forecasts that its plan was made with, at `stages` (ascending, ≥ 0); by
/// obstacle in the order of controller::moving_obstacles. Empty where nothing moves, and for
/// periods from the first one on of which the trace has no finite measurement of each obstacle.
[[nodiscard]] std::vector<KnownForecasts> seen_forecasts(const Trace& trace,
                                                         const std::vector<int>& stages);

}  // namespace qsmpc::harness
