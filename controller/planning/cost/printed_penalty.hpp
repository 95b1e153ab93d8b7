// The loops of the published penalties (Algorithm 2, Eq. 4-10) over the particles of one stage, for
// the processor's widest vectors. Both add to the batch's gradient.
#pragma once

#include <vector>

#include "controller/planning/cost/stage_term.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// `scale` times the weighted sum of the distances of the particles outside each interval.
double printed_bounds_penalty(const std::vector<AxisInterval>& bounds, double scale,
                              const TermBatch& batch);

/// `scale` times the weighted sum over the particles of the largest obstacle indicator: 1 inside,
/// falling to 0 over one unit outside. obstacles: the bounded intervals of each.
double printed_obstacle_penalty(const std::vector<std::vector<AxisInterval>>& obstacles,
                                double scale, const TermBatch& batch);

}  // namespace qsmpc::controller
