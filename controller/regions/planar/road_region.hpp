// The region outside of a road.
#pragma once

#include <memory>

#include "controller/regions/planar/road_walls.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// The walls with all that is nearer to them than growth.radius, in the plane of growth.x and
/// growth.y, which both must be states.
[[nodiscard]] RegionPointer make_road(std::shared_ptr<const RoadWalls> walls, const Growth& growth);

}  // namespace qsmpc::controller
