// The region of a planar shape that moves according to a forecast.
#pragma once

#include <cstddef>
#include <memory>

#include "controller/regions/planar/planar_shape.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"

namespace qsmpc::controller {

/// Standard deviations of its place by which an obstacle is grown for distances and penalties.
/// These serve planning; bounds and tails use the whole law.
inline constexpr double kKeptDeviations = 2.0;

/// The shape and all points nearer to it than growth.radius, in the plane of the states growth.x
/// and growth.y (neither may be -1), moved as `forecast` predicts obstacle `index` at the time of
/// the query. Its places are grown by kKeptDeviations for distances, faces and penalties. Distances
/// and faces are those of the nearest place that is not improbable; penalties are expectations over
/// all places. `shape` must pass check_planar_shape.
[[nodiscard]] RegionPointer make_moving_shape(const PlanarShape& shape, const Growth& growth,
                                              std::shared_ptr<const ObstacleForecast> forecast,
                                              std::size_t index);

}  // namespace qsmpc::controller
