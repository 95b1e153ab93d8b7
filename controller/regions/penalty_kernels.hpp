// SIMD loops for the smooth penalties of walls and boxes over the particles of one stage, for the
// processor's widest vectors.
#pragma once

#include <vector>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

/// As UnsafeRegion::add_penalty, for both ends of one coordinate's bounds; where they overlap, both
/// count.
double wall_penalty(const AxisInterval& bounds, const PenaltyBatch& batch);

/// As UnsafeRegion::add_penalty, for the box with these intervals.
double box_penalty(const std::vector<AxisInterval>& intervals, const PenaltyBatch& batch);

}  // namespace qsmpc::controller
