// SIMD loops for the distances from many points to walls and boxes, for the processor's widest
// vectors.
#pragma once

#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// As UnsafeRegion::lower_to_distances, for the outside of these intervals.
void lower_to_wall_distances(const std::vector<AxisInterval>& intervals, const Points& points,
                             Eigen::ArrayXd& least);

/// As UnsafeRegion::lower_to_distances, for the points nearer than `radius` to the box with these
/// intervals.
void lower_to_box_distances(const std::vector<AxisInterval>& intervals, double radius,
                            const Points& points, Eigen::ArrayXd& least);

}  // namespace qsmpc::controller
