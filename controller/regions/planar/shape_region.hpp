// The region of a shape of the plane of position.
#pragma once

#include "controller/regions/planar/convex_bound.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// The shape with all that is nearer to it than growth.radius, in the plane of growth.x and
/// growth.y, which both must be states. `shape` must be one that check_planar_shape takes.
[[nodiscard]] RegionPointer make_shape(const PlanarShape& shape, const Growth& growth);

}  // namespace qsmpc::controller
