#include "harness/figures/map_content.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "harness/figures/axis.hpp"
#include "harness/figures/palette.hpp"

namespace qsmpc::harness {
namespace {

using Eigen::Index;

// Per map; more would not be visible, and would make the file large.
constexpr std::size_t kMostDots = 4000;

// Edges of half-planes count up to this distance from the map's middle, in lengths of its other
// content.
constexpr double kNearEdge = 1.5;

MapPoint point_of(const Eigen::Ref<const Eigen::Matrix2Xd>& points, Index i) {
  return {.x = points(0, i), .y = points(1, i)};
}

/// Weight of point i; 0 if it is not to be drawn.
double weight_of(const MapCloud& cloud, Index i) {
  if (!is_drawable(point_of(cloud.points, i))) return 0.0;
  if (cloud.weights.size() == 0) return 1.0;
  if (i >= cloud.weights.size() || !is_drawable(cloud.weights[i])) return 0.0;
  return std::max(0.0, cloud.weights[i]);
}

std::size_t drawable_dots(const MapCloud& cloud) {
  std::size_t count = 0;
  for (Index i = 0; i < cloud.points.cols(); ++i) count += weight_of(cloud, i) > 0.0 ? 1 : 0;
  return count;
}

/// Collects the coordinates of the map's content.
class Extent {
 public:
  void include(const MapPoint& point) {
    if (!is_drawable(point)) return;
    across_.push_back(point.x);
    up_.push_back(point.y);
  }
  /// Includes what extends from `point` by these lengths to each side.
  void include(const MapPoint& point, double across, double up) {
    include({.x = point.x - across, .y = point.y - up});
    include({.x = point.x + across, .y = point.y + up});
  }
  /// Infinite sides do not count.
  void include(const MapRectangle& box) {
    across_.insert(across_.end(), {box.x_lower, box.x_upper});
    up_.insert(up_.end(), {box.y_lower, box.y_upper});
  }

  [[nodiscard]] MapRectangle within(const MapRectangle& bounds) const {
    const Axis x = shown(bounds.x_lower, bounds.x_upper, across_);
    const Axis y = shown(bounds.y_lower, bounds.y_upper, up_);
    return {.x_lower = x.lower, .x_upper = x.upper, .y_lower = y.lower, .y_upper = y.upper};
  }

 private:
  /// One axis: the bounds, if finite, and the content around them. Content far beyond is cut off,
  /// so that the rest stays visible.
  [[nodiscard]] static Axis shown(double lower, double upper, std::vector<double> contents) {
    constexpr double kMargin = 0.04;  // of the length, on each side
    const bool bounded = is_drawable(lower) && is_drawable(upper) && upper > lower;
    contents.insert(contents.end(), {lower, upper});
    Axis axis = tight_axis(contents);
    if (bounded) {
      const double length = upper - lower;
      axis.lower = std::clamp(axis.lower, lower - length, lower);
      axis.upper = std::clamp(axis.upper, upper, upper + length);
    }
    const double margin = kMargin * (axis.upper - axis.lower);
    return {.lower = axis.lower - margin, .upper = axis.upper + margin};
  }

  std::vector<double> across_;
  std::vector<double> up_;
};

void include_uncertainty(Extent& extent, const PlaneMap& map) {
  for (const MapEllipse& ellipse : map.ellipses) {
    if (!is_shown(ellipse)) continue;
    const MapPoint mean{.x = ellipse.mean.x(), .y = ellipse.mean.y()};
    for (const double level : ellipse.levels) {
      if (!is_shown(level)) continue;
      const Eigen::Vector2d reach =
          (-2.0 * std::log1p(-level) * ellipse.covariance.diagonal().cwiseMax(0.0)).cwiseSqrt();
      extent.include(mean, reach.x(), reach.y());
    }
  }
  for (const MapCloud& cloud : map.clouds) {
    for (Index i = 0; i < cloud.points.cols(); ++i) {
      if (weight_of(cloud, i) > 0.0) extent.include(point_of(cloud.points, i));
    }
  }
  for (const MapContours& contours : map.contours) {
    for (const MapContour& line : contours.lines) {
      for (const MapPoint& point : points_of(line.points)) extent.include(point);
    }
  }
}

/// Includes, for each half-plane, the point of its edge that is nearest to the middle of `area`, if
/// it is near enough.
void include_edges(Extent& extent, const PlaneMap& map, const MapRectangle& area) {
  const MapPoint middle{.x = 0.5 * (area.x_lower + area.x_upper),
                        .y = 0.5 * (area.y_lower + area.y_upper)};
  const double near =
      kNearEdge * std::max(area.x_upper - area.x_lower, area.y_upper - area.y_lower);
  for (const MapHalfPlane& half_plane : map.half_planes) {
    const MapPoint point = nearest_on_edge(half_plane, middle);
    if (std::hypot(point.x - middle.x, point.y - middle.y) <= near) extent.include(point);
  }
}

/// At most `most` ≥ 1 points, picked at equal steps of the cumulative weight (systematic
/// resampling), so that every region keeps its share.
std::vector<MapDot> dots_of(const MapCloud& cloud, std::size_t most) {
  double total = 0.0;
  for (Index i = 0; i < cloud.points.cols(); ++i) total += weight_of(cloud, i);
  const std::size_t positive = drawable_dots(cloud);
  std::vector<MapDot> dots;
  double sum = 0.0;
  double picked = 0.0;
  const auto picks = static_cast<double>(most);
  for (Index i = 0; i < cloud.points.cols(); ++i) {
    const double share = weight_of(cloud, i) / total;
    if (!(share > 0.0)) continue;
    const MapPoint at = point_of(cloud.points, i);
    if (positive <= most) {
      dots.push_back({.at = at, .share = share});
      continue;
    }
    sum += share;
    const double reached = std::floor(sum * picks + 0.5);
    if (reached > picked) dots.push_back({.at = at, .share = (reached - picked) / picks});
    picked = std::max(picked, reached);
  }
  return dots;
}

/// The number of dots that each cloud may have: small clouds keep all of theirs, the others share
/// the rest.
std::vector<std::size_t> room_of(const std::vector<MapCloud>& clouds) {
  std::vector<std::size_t> count;
  count.reserve(clouds.size());
  for (const MapCloud& cloud : clouds) count.push_back(drawable_dots(cloud));
  std::vector<std::size_t> order(clouds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return count[a] < count[b]; });
  std::vector<std::size_t> room(clouds.size());
  std::size_t left = kMostDots;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const std::size_t fair = left / (order.size() - n);
    room[order[n]] = std::min(count[order[n]], fair);
    left -= room[order[n]];
  }
  return room;
}

}  // namespace

std::string colour_class(int colour) {
  return fmt::format("c{}", std::clamp(colour, 0, kFirstScale + kScaleSize - 1));
}

std::string path_classes(const MapPath& path) {
  return std::string("way ") + (path.faint ? "faint " : "") + (path.dashed ? "broken " : "") +
         colour_class(path.colour);
}

std::string body_classes(const MapBody& body) {
  return "outline thin " + colour_class(body.colour);
}

bool is_finite(const MapRectangle& box) {
  return is_drawable(box.x_lower) && is_drawable(box.x_upper) && is_drawable(box.y_lower) &&
         is_drawable(box.y_upper);
}

bool is_shown(const MapCircle& circle) {
  return is_drawable(circle.centre) && is_drawable(circle.radius) && circle.radius >= 0.0;
}

bool is_shown(const MapEllipse& ellipse) {
  return is_drawable(ellipse.mean.cwiseAbs().maxCoeff()) && ellipse.mean.allFinite() &&
         ellipse.covariance.allFinite() && is_drawable(ellipse.covariance.cwiseAbs().maxCoeff());
}

bool is_shown(double level) { return level > 0.0 && level < 1.0; }

std::vector<MapPoint> points_of(const Eigen::Ref<const Eigen::Matrix2Xd>& points) {
  std::vector<MapPoint> list;
  for (Index i = 0; i < points.cols(); ++i) list.push_back(point_of(points, i));
  return list;
}

std::vector<std::vector<MapDot>> dots_of(const PlaneMap& map) {
  const std::vector<std::size_t> room = room_of(map.clouds);
  std::vector<std::vector<MapDot>> dots;
  for (std::size_t n = 0; n < map.clouds.size(); ++n) {
    dots.push_back(room[n] > 0 ? dots_of(map.clouds[n], room[n]) : std::vector<MapDot>());
  }
  return dots;
}

std::size_t drawable_dots(const PlaneMap& map) {
  std::size_t count = 0;
  for (const MapCloud& cloud : map.clouds) count += drawable_dots(cloud);
  return count;
}

/// Values of the map that cannot be drawn.
std::size_t omitted_values(const PlaneMap& map) {
  std::size_t count = 0;
  for (const MapPath& path : map.paths) {
    count += static_cast<std::size_t>(
        std::count_if(path.points.begin(), path.points.end(),
                      [](const MapPoint& point) { return !is_drawable(point); }));
  }
  for (const MapCloud& cloud : map.clouds) {
    for (Index i = 0; i < cloud.points.cols(); ++i) {
      const bool weighted =
          cloud.weights.size() == 0 || (i < cloud.weights.size() && is_drawable(cloud.weights[i]));
      if (!weighted || !is_drawable(point_of(cloud.points, i))) ++count;
    }
  }
  for (const MapEllipse& ellipse : map.ellipses) count += is_shown(ellipse) ? 0 : 1;
  for (const MapCircle& target : map.targets) count += is_shown(target) ? 0 : 1;
  return count;
}

MapRectangle map_area(const PlaneMap& map) {
  Extent extent;
  for (const auto* boxes : {&map.obstacles, &map.partial_obstacles}) {
    for (const MapRectangle& box : *boxes) extent.include(box);
  }
  for (const MapPolygon& polygon : map.polygons) {
    for (const MapPoint& corner : polygon.corners) extent.include(corner);
  }
  for (const MapPath& line : map.lines) {
    for (const MapPoint& point : line.points) extent.include(point);
  }
  for (const MapCircle& target : map.targets) {
    if (is_shown(target)) extent.include(target.centre, target.radius, target.radius);
  }
  for (const MapPath& path : map.paths) {
    for (const MapPoint& point : path.points) extent.include(point);
  }
  for (const MapLabel& label : map.labels) extent.include(label.at);
  include_uncertainty(extent, map);
  include_edges(extent, map, extent.within(map.bounds));
  return extent.within(map.bounds);
}

bool has_content(const PlaneMap& map) {
  const auto cloud_shows = [](const MapCloud& cloud) { return drawable_dots(cloud) > 0; };
  const auto path_shows = [](const MapPath& path) {
    return std::any_of(path.points.begin(), path.points.end(),
                       [](const MapPoint& point) { return is_drawable(point); });
  };
  const auto contours_show = [](const MapContours& contours) { return !contours.lines.empty(); };
  return !map.obstacles.empty() || !map.partial_obstacles.empty() || !map.polygons.empty() ||
         !map.half_planes.empty() || is_finite(map.bounds) ||
         std::any_of(map.targets.begin(), map.targets.end(),
                     [](const MapCircle& target) { return is_shown(target); }) ||
         std::any_of(map.paths.begin(), map.paths.end(), path_shows) ||
         std::any_of(map.clouds.begin(), map.clouds.end(), cloud_shows) ||
         std::any_of(map.ellipses.begin(), map.ellipses.end(),
                     [](const MapEllipse& ellipse) { return is_shown(ellipse); }) ||
         std::any_of(map.contours.begin(), map.contours.end(), contours_show);
}

}  // namespace qsmpc::harness
