// Outlines of obstacles that are not axis-aligned boxes: polygons in the plane, corners in order.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

using PlanarOutline = std::vector<PlanarPoint>;

/// Counterclockwise; its sides are finite.
[[nodiscard]] PlanarOutline corners_of(const PlanarRectangle& area);

/// The part of an outline in a half-plane (Sutherland and Hodgman 1974), possibly empty. Parts of a
/// non-convex outline stay joined by edges along that of the half-plane.
[[nodiscard]] PlanarOutline clipped_to(const PlanarOutline& outline,
                                       const PlanarHalfPlane& half_plane);

/// The same within a rectangle with finite sides.
[[nodiscard]] PlanarOutline clipped_to(PlanarOutline outline, const PlanarRectangle& area);

/// The prism's part within a rectangle.
[[nodiscard]] Prism clipped_to(const Prism& prism, const PlanarRectangle& area);

/// The nearest point of the half-plane's edge.
[[nodiscard]] PlanarPoint nearest_on_edge(const PlanarHalfPlane& half_plane,
                                          const PlanarPoint& point);

/// Appends the ends of diagonal lines that fill `outline` at `height`, where x + y is a multiple of
/// `spacing`.
void append_stripes(const PlanarOutline& outline, double height, double spacing,
                    std::vector<SpacePoint>& ends);

}  // namespace qsmpc::render
