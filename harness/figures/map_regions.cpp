#include "harness/figures/map_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace qsmpc::harness {
namespace {

constexpr double kUnseen = 0.05;  // tolerance of an outline, in view box units

/// Depth of `point` in the half-plane, scaled by the length of its normal.
double depth_in(const MapHalfPlane& half_plane, const MapPoint& point) {
  return half_plane.normal.x * point.x + half_plane.normal.y * point.y - half_plane.offset;
}

double distance_to_segment(const MapPoint& point, const MapPoint& from, const MapPoint& to) {
  const double x = to.x - from.x;
  const double y = to.y - from.y;
  const double square = x * x + y * y;
  const double along = (point.x - from.x) * x + (point.y - from.y) * y;
  const double share = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  return std::hypot(point.x - from.x - share * x, point.y - from.y - share * y);
}

/// Drops points that lie within `kUnseen` of the remaining outline. At least 3 remain of at least
/// 3.
std::vector<MapPoint> without_unseen(const std::vector<MapPoint>& points) {
  std::vector<MapPoint> kept;
  for (std::size_t from = 0; from < points.size();) {
    kept.push_back(points[from]);
    std::size_t to = from + 1;
    const auto is_straight_to = [&](std::size_t end) {
      for (std::size_t i = from + 1; i < end; ++i) {
        const MapPoint& target = points[end % points.size()];
        if (distance_to_segment(points[i], points[from], target) > kUnseen) return false;
      }
      return true;
    };
    while (to < points.size() && is_straight_to(to + 1)) ++to;
    from = to;
  }
  return kept.size() < 3 ? points : kept;
}

}  // namespace

std::vector<MapPoint> clipped(const std::vector<MapPoint>& corners,
                              const MapHalfPlane& half_plane) {
  std::vector<MapPoint> part;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const MapPoint& from = corners[i];
    const MapPoint& to = corners[(i + 1) % corners.size()];
    const double depth = depth_in(half_plane, from);
    const double next = depth_in(half_plane, to);
    if (depth >= 0.0) part.push_back(from);
    if ((depth > 0.0 && next < 0.0) || (depth < 0.0 && next > 0.0)) {
      const double share = depth / (depth - next);
      part.push_back(
          {.x = from.x + share * (to.x - from.x), .y = from.y + share * (to.y - from.y)});
    }
  }
  return part.size() < 3 ? std::vector<MapPoint>() : part;
}

std::vector<MapPoint> clipped(std::vector<MapPoint> corners, const MapRectangle& area) {
  const std::array<MapHalfPlane, 4> sides = {{{.normal = {1.0, 0.0}, .offset = area.x_lower},
                                              {.normal = {-1.0, 0.0}, .offset = -area.x_upper},
                                              {.normal = {0.0, 1.0}, .offset = area.y_lower},
                                              {.normal = {0.0, -1.0}, .offset = -area.y_upper}}};
  for (const MapHalfPlane& side : sides) {
    if (std::isfinite(side.offset)) corners = clipped(corners, side);
  }
  return corners;
}

std::vector<MapPoint> corners_of(const MapRectangle& area) {
  return {{.x = area.x_lower, .y = area.y_lower},
          {.x = area.x_upper, .y = area.y_lower},
          {.x = area.x_upper, .y = area.y_upper},
          {.x = area.x_lower, .y = area.y_upper}};
}

MapPoint nearest_on_edge(const MapHalfPlane& half_plane, const MapPoint& point) {
  const MapPoint& normal = half_plane.normal;
  const double way = depth_in(half_plane, point) / (normal.x * normal.x + normal.y * normal.y);
  return {.x = point.x - way * normal.x, .y = point.y - way * normal.y};
}

std::string polygon_svg(const MapCanvas& canvas, const std::vector<MapPoint>& corners,
                        const std::string& classes) {
  if (!std::all_of(corners.begin(), corners.end(),
                   [](const MapPoint& corner) { return is_drawable(corner); })) {
    return {};
  }
  std::vector<MapPoint> places;
  for (const MapPoint& corner : clipped(corners, canvas.area())) {
    places.push_back(canvas.place(corner));
  }
  std::string data;
  std::string last;
  for (const MapPoint& place : without_unseen(places)) {
    const std::string at = MapCanvas::written(place);
    if (at != last) data += (data.empty() ? "M" : "L") + at;
    last = at;
  }
  if (data.empty()) return {};
  return "<path class=\"" + classes + "\" d=\"" + data + "Z\"/>";
}

std::string half_plane_svg(const MapCanvas& canvas, const MapHalfPlane& half_plane,
                           const std::string& classes) {
  return polygon_svg(canvas, clipped(corners_of(canvas.area()), half_plane), classes);
}

}  // namespace qsmpc::harness
