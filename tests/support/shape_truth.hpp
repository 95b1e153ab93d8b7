// Whether a point is in or near a shape, computed independently: the reference for regions.
#pragma once

#include "controller/regions/planar/planar_shape.hpp"

namespace qsmpc::testing {

/// Whether the shape has a point within `reach` (≥ 0, m) of `point`. An ellipse is searched by its
/// angle, to a tolerance of 1e-6 of its size.
[[nodiscard]] bool is_near(const controller::PlanarShape& shape, const Eigen::Vector2d& point,
                           double reach);

}  // namespace qsmpc::testing
