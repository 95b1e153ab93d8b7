// The region of a shape in the plane of position.
#pragma once

#include "controller/regions/planar/convex_bound.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// The shape and all points nearer to it than growth.radius, in the plane of the states growth.x
/// and growth.y (neither may be -1). `shape` must pass check_planar_shape.
[[nodiscard]] RegionPointer make_shape(const PlanarShape& shape, const Growth& growth);

}  // namespace qsmpc::controller
