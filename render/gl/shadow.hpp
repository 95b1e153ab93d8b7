// Shadows on level ground, as outlines: cheaper than a shadow map by an order of magnitude.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

/// The outline of the shadow that the convex hull of `corners` casts on the ground,
/// counter-clockwise.
[[nodiscard]] std::vector<PlanarPoint> cast_shadow(const std::vector<SpacePoint>& corners);

/// The same for an upright box of `height` metres.
[[nodiscard]] std::vector<PlanarPoint> box_shadow(const PlanarRectangle& area, double height);

/// The same for an upright prism with a convex outline.
[[nodiscard]] std::vector<PlanarPoint> prism_shadow(const std::vector<PlanarPoint>& outline,
                                                    double height);

/// Counter-clockwise corners of the convex hull of `points`.
[[nodiscard]] std::vector<PlanarPoint> convex_hull(std::vector<PlanarPoint> points);

}  // namespace qsmpc::render
