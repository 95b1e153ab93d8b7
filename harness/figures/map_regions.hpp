// Regions of a map that are no axis-aligned boxes, and the part of them that is shown.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/map_canvas.hpp"

namespace qsmpc::harness {

/// A polygon that does not meet itself; its corners in turn.
struct MapPolygon {
  std::vector<MapPoint> corners{};
};

/// The points p with normal · p ≥ offset; the normal is of any length but 0.
struct MapHalfPlane {
  MapPoint normal{.x = 1.0};
  double offset = 0.0;
};

/// The part of the polygon in the half-plane (Sutherland and Hodgman 1974), empty where there is
/// none. Parts of a polygon that is not convex stay joined by edges along the half-plane's.
[[nodiscard]] std::vector<MapPoint> clipped(const std::vector<MapPoint>& corners,
                                            const MapHalfPlane& half_plane);

/// The same within a rectangle, whose sides may be infinite.
[[nodiscard]] std::vector<MapPoint> clipped(std::vector<MapPoint> corners,
                                            const MapRectangle& area);

/// Counterclockwise; its sides are finite.
[[nodiscard]] std::vector<MapPoint> corners_of(const MapRectangle& area);

/// The nearest point of the half-plane's edge.
[[nodiscard]] MapPoint nearest_on_edge(const MapHalfPlane& half_plane, const MapPoint& point);

/// The part of the polygon that the canvas shows, without corners that nobody could see; empty if
/// there is none.
[[nodiscard]] std::string polygon_svg(const MapCanvas& canvas, const std::vector<MapPoint>& corners,
                                      const std::string& classes);

/// The same of a half-plane.
[[nodiscard]] std::string half_plane_svg(const MapCanvas& canvas, const MapHalfPlane& half_plane,
                                         const std::string& classes);

}  // namespace qsmpc::harness
