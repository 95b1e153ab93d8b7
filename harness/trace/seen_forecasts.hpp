// What was known of the moving obstacles when each plan was made. A trace holds only the
// measurements of the obstacles, so their forecasts are recomputed from these.
//
//   const auto known = seen_forecasts(trace, {0, 5, 10});
//   known[k][n][1];   // the places at stage 5 of obstacle n, as known in period k
#pragma once

#include <vector>

#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// The forecast of each obstacle, at some stages.
using KnownForecasts = std::vector<controller::PlacesByStage>;

/// At most `most` ≥ 2 of the stages 0 … `horizon` ≥ 0, evenly spread and always including the first
/// and the last.
[[nodiscard]] std::vector<int> spread_stages(int horizon, int most);

/// For each period, the forecasts that its plan was made with, at `stages` (ascending, ≥ 0), by
/// obstacle in the order of controller::moving_obstacles. An entry is empty if nothing moves, and
/// from the first period on in which some obstacle has no finite measurement.
[[nodiscard]] std::vector<KnownForecasts> seen_forecasts(const Trace& trace,
                                                         const std::vector<int>& stages);

}  // namespace qsmpc::harness
