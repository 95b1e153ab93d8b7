// Regions of a map other than axis-aligned boxes, and their visible parts.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/map_canvas.hpp"

namespace qsmpc::harness {

/// A simple polygon, given by its corners in order.
struct MapPolygon {
  std::vector<MapPoint> corners{};
};

/// The points p with normal · p ≥ offset; the normal has any non-zero length.
struct MapHalfPlane {
  MapPoint normal{.x = 1.0};
  double offset = 0.0;
};

/// The part of the polygon in the half-plane (Sutherland and Hodgman 1974), empty if there is none.
/// The parts of a non-convex polygon stay connected by edges along the half-plane's edge.
[[nodiscard]] std::vector<MapPoint> clipped(const std::vector<MapPoint>& corners,
                                            const MapHalfPlane& half_plane);

/// The part of the polygon within a rectangle, whose sides may be infinite.
[[nodiscard]] std::vector<MapPoint> clipped(std::vector<MapPoint> corners,
                                            const MapRectangle& area);

/// The corners, counterclockwise, of `area`, whose sides are finite.
[[nodiscard]] std::vector<MapPoint> corners_of(const MapRectangle& area);

/// The nearest point of the half-plane's edge.
[[nodiscard]] MapPoint nearest_on_edge(const MapHalfPlane& half_plane, const MapPoint& point);

/// The visible part of the polygon, without corners too small to see; empty if there is none.
[[nodiscard]] std::string polygon_svg(const MapCanvas& canvas, const std::vector<MapPoint>& corners,
                                      const std::string& classes);

/// The same for a half-plane.
[[nodiscard]] std::string half_plane_svg(const MapCanvas& canvas, const MapHalfPlane& half_plane,
                                         const std::string& classes);

}  // namespace qsmpc::harness
