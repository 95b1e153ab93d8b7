// Which parts of a map can be drawn, and how much of them is drawn.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/figures/map_shapes.hpp"
#include "harness/figures/plane_map.hpp"

namespace qsmpc::harness {

/// The attribute of a circle's element that distinguishes a waypoint from the target.
inline constexpr const char* kWaypointStyle = " style=\"fill-opacity:0.06;stroke-dasharray:4 3\"";

/// "c0" … "c9", for any number.
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

/// The dots of each cloud: all of them, or, if all clouds together have more than some thousands of
/// points, a limited number from the large clouds.
[[nodiscard]] std::vector<std::vector<MapDot>> dots_of(const PlaneMap& map);

/// Number of drawable points in all clouds.
[[nodiscard]] std::size_t drawable_dots(const PlaneMap& map);

/// Number of points, ellipses and circles that cannot be drawn.
[[nodiscard]] std::size_t omitted_values(const PlaneMap& map);

}  // namespace qsmpc::harness
