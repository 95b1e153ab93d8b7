// The region outside a road.
#pragma once

#include <memory>

#include "controller/regions/planar/road_walls.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// The walls and all points nearer to them than growth.radius, in the plane of the states growth.x
/// and growth.y (neither may be -1).
[[nodiscard]] RegionPointer make_road(std::shared_ptr<const RoadWalls> walls, const Growth& growth);

}  // namespace qsmpc::controller
