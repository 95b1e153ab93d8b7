// Outlines of obstacles that are no axis-aligned boxes: polygons of the plane, corners in turn.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

using PlanarOutline = std::vector<PlanarPoint>;

/// Counterclockwise; its sides are finite.
[[nodiscard]] PlanarOutline corners_of(const PlanarRectangle& area);

/// The part of an outline in a half-plane (Sutherland and Hodgman 1974), empty where there is none.
/// Parts of one that is not convex stay joined by edges along the half-plane's.
[[nodiscard]] PlanarOutline clipped_to(const PlanarOutline& outline,
                                       const PlanarHalfPlane& half_plane);

/// The same within a rectangle whose sides are finite.
[[nodiscard]] PlanarOutline clipped_to(PlanarOutline outline, const PlanarRectangle& area);

/// The prism's part within a rectangle.
[[nodiscard]] Prism clipped_to(const Prism& prism, const PlanarRectangle& area);

/// The nearest point of the half-plane's edge.
[[nodiscard]] PlanarPoint nearest_on_edge(const PlanarHalfPlane& half_plane,
                                          const PlanarPoint& point);

/// Appends the ends of diagonal lines that fill `outline` at `height`, at multiples of `spacing` of
/// x + y.
void append_stripes(const PlanarOutline& outline, double height, double spacing,
                    std::vector<SpacePoint>& ends);

}  // namespace qsmpc::render
