// The region of a shape of the plane of position that moves as a forecast says.
#pragma once

#include <cstddef>
#include <memory>

#include "controller/regions/planar/planar_shape.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"

namespace qsmpc::controller {

/// Standard deviations of its place by which an obstacle is grown where a distance is asked for, or
/// a penalty. Those are for planning; bounds and tails take the whole law.
inline constexpr double kKeptDeviations = 2.0;

/// The shape with all that is nearer to it than growth.radius, in the plane of growth.x and
/// growth.y, which both must be states, moved as `forecast` has obstacle `index` at the time of
/// asking. Distances and faces are those of the nearest of its places that are not improbable, each
/// grown by kKeptDeviations; of penalties the expectation over them is taken. `shape` must be one
/// that check_planar_shape takes.
[[nodiscard]] RegionPointer make_moving_shape(const PlanarShape& shape, const Growth& growth,
                                              std::shared_ptr<const ObstacleForecast> forecast,
                                              std::size_t index);

}  // namespace qsmpc::controller
