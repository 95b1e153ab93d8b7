// The loops of the distances to walls and boxes over many points, for the processor's widest
// vectors.
#pragma once

#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// As UnsafeRegion::lower_to_distances, of what is outside of these intervals.
void lower_to_wall_distances(const std::vector<AxisInterval>& intervals, const Points& points,
                             Eigen::ArrayXd& least);

/// As UnsafeRegion::lower_to_distances, of what is nearer than `radius` to the box that is bounded
/// in these intervals.
void lower_to_box_distances(const std::vector<AxisInterval>& intervals, double radius,
                            const Points& points, Eigen::ArrayXd& least);

}  // namespace qsmpc::controller
