// Whether a point is in or near a shape, by means of its own: what regions are held against.
#pragma once

#include "controller/regions/planar/planar_shape.hpp"

namespace qsmpc::testing {

/// Whether the shape has a point within `reach` (≥ 0, m) of `point`. About an ellipse, which is
/// searched by its angle, up to 1e-6 of its size less.
[[nodiscard]] bool is_near(const controller::PlanarShape& shape, const Eigen::Vector2d& point,
                           double reach);

}  // namespace qsmpc::testing
