#include "render/gl/shadow.hpp"

#include <algorithm>
#include <cstddef>

namespace qsmpc::render {
namespace {

// Shift of a shadow per metre of height, m; the sun is that of the vehicles' files.
constexpr PlanarPoint kShadowShift{0.3 / 0.9, -0.36 / 0.9};

double turn(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Half of Andrew's monotone chain: the points of a sorted range with left turns only.
template <typename Iterator>
std::vector<PlanarPoint> left_chain(Iterator begin, Iterator end) {
  std::vector<PlanarPoint> chain;
  for (auto point = begin; point != end; ++point) {
    while (chain.size() > 1 && turn(chain[chain.size() - 2], chain.back(), *point) <= 0.0) {
      chain.pop_back();
    }
    chain.push_back(*point);
  }
  return chain;
}

}  // namespace

std::vector<PlanarPoint> convex_hull(std::vector<PlanarPoint> points) {
  std::sort(points.begin(), points.end(), [](const PlanarPoint& a, const PlanarPoint& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  if (points.size() < 3) {
    return points;
  }
  std::vector<PlanarPoint> hull = left_chain(points.begin(), points.end());
  const std::vector<PlanarPoint> upper = left_chain(points.rbegin(), points.rend());
  hull.pop_back();
  hull.insert(hull.end(), upper.begin(), upper.end() - 1);
  return hull;
}

std::vector<PlanarPoint> cast_shadow(const std::vector<SpacePoint>& corners) {
  std::vector<PlanarPoint> points;
  points.reserve(corners.size());
  for (const SpacePoint& corner : corners) {
    const double height = std::max(corner[2], 0.0);
    points.push_back({corner[0] + height * kShadowShift.x, corner[1] + height * kShadowShift.y});
  }
  return convex_hull(std::move(points));
}

std::vector<PlanarPoint> box_shadow(const PlanarRectangle& area, double height) {
  std::vector<SpacePoint> corners;
  for (const double x : {area.x_lower, area.x_upper}) {
    for (const double y : {area.y_lower, area.y_upper}) {
      corners.push_back({x, y, 0.0});
      corners.push_back({x, y, height});
    }
  }
  return cast_shadow(corners);
}

std::vector<PlanarPoint> prism_shadow(const std::vector<PlanarPoint>& outline, double height) {
  std::vector<SpacePoint> corners;
  for (const PlanarPoint& corner : outline) {
    corners.push_back({corner.x, corner.y, 0.0});
    corners.push_back({corner.x, corner.y, height});
  }
  return cast_shadow(corners);
}

}  // namespace qsmpc::render
