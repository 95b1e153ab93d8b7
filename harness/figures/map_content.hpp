// What of a map can be drawn, and how much of it is.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/figures/map_shapes.hpp"
#include "harness/figures/plane_map.hpp"

namespace qsmpc::harness {

/// What tells a waypoint from the target, within its circle's element.
inline constexpr const char* kWaypointStyle = " style=\"fill-opacity:0.06;stroke-dasharray:4 3\"";

/// "c0" … "c9", whatever number was given.
[[nodiscard]] std::string colour_class(int colour);
[[nodiscard]] std::string path_classes(const MapPath& path);
[[nodiscard]] std::string body_classes(const MapBody& body);

/// Whether all four sides are finite.
[[nodiscard]] bool is_finite(const MapRectangle& box);

[[nodiscard]] bool is_shown(const MapCircle& circle);
[[nodiscard]] bool is_shown(const MapEllipse& ellipse);
/// Whether `level` lies in (0, 1), as a probability of an ellipse must.
[[nodiscard]] bool is_shown(double level);

[[nodiscard]] std::vector<MapPoint> points_of(const Eigen::Ref<const Eigen::Matrix2Xd>& points);

/// The dots of each cloud: all of them, or, where all clouds together have more than some thousands
/// of points, as many of the large ones as there is room for.
[[nodiscard]] std::vector<std::vector<MapDot>> dots_of(const PlaneMap& map);

/// Points of all clouds that can be drawn.
[[nodiscard]] std::size_t drawable_dots(const PlaneMap& map);

/// How many points, ellipses and circles cannot be drawn.
[[nodiscard]] std::size_t omitted_values(const PlaneMap& map);

}  // namespace qsmpc::harness
