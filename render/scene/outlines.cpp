#include "render/scene/outlines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "models/constants.hpp"

namespace qsmpc::render {
namespace {

// Depth times the length of the half-plane's normal.
double depth_in(const PlanarHalfPlane& half_plane, const PlanarPoint& point) {
  return half_plane.normal.x * point.x + half_plane.normal.y * point.y - half_plane.offset;
}

}  // namespace

PlanarOutline corners_of(const PlanarRectangle& area) {
  return {{area.x_lower, area.y_lower},
          {area.x_upper, area.y_lower},
          {area.x_upper, area.y_upper},
          {area.x_lower, area.y_upper}};
}

PlanarOutline clipped_to(const PlanarOutline& outline, const PlanarHalfPlane& half_plane) {
  PlanarOutline part;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const PlanarPoint& from = outline[i];
    const PlanarPoint& to = outline[(i + 1) % outline.size()];
    const double depth = depth_in(half_plane, from);
    const double next = depth_in(half_plane, to);
    if (depth >= 0.0) part.push_back(from);
    if ((depth > 0.0 && next < 0.0) || (depth < 0.0 && next > 0.0)) {
      const double share = depth / (depth - next);
      part.push_back({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)});
    }
  }
  return part.size() < 3 ? PlanarOutline() : part;
}

PlanarOutline clipped_to(PlanarOutline outline, const PlanarRectangle& area) {
  const std::array<PlanarHalfPlane, 4> sides = {{{{1.0, 0.0}, area.x_lower},
                                                 {{-1.0, 0.0}, -area.x_upper},
                                                 {{0.0, 1.0}, area.y_lower},
                                                 {{0.0, -1.0}, -area.y_upper}}};
  for (const PlanarHalfPlane& side : sides) outline = clipped_to(outline, side);
  return outline;
}

Prism clipped_to(const Prism& prism, const PlanarRectangle& area) {
  Prism part{.outline = clipped_to(prism.outline, area), .pieces = {}};
  for (const PlanarOutline& piece : prism.pieces) {
    PlanarOutline shown = clipped_to(piece, area);
    if (!shown.empty()) part.pieces.push_back(std::move(shown));
  }
  return part;
}

PlanarPoint nearest_on_edge(const PlanarHalfPlane& half_plane, const PlanarPoint& point) {
  const PlanarPoint& normal = half_plane.normal;
  const double way = depth_in(half_plane, point) / (normal.x * normal.x + normal.y * normal.y);
  return {point.x - way * normal.x, point.y - way * normal.y};
}

void append_stripes(const PlanarOutline& outline, double height, double spacing,
                    std::vector<SpacePoint>& ends) {
  double begin = kInfinity;
  double end = -kInfinity;
  for (const PlanarPoint& corner : outline) {
    begin = std::min(begin, corner.x + corner.y);
    end = std::max(end, corner.x + corner.y);
  }
  std::vector<double> crossings;  // x where the stripe enters and leaves, in turn
  for (double i = std::floor(begin / spacing) + 1.0; i * spacing < end; ++i) {
    const double sum = i * spacing;
    crossings.clear();
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const PlanarPoint& from = outline[k];
      const PlanarPoint& to = outline[(k + 1) % outline.size()];
      const double before = from.x + from.y - sum;
      const double after = to.x + to.y - sum;
      if ((before < 0.0) == (after < 0.0)) continue;
      crossings.push_back(from.x + before / (before - after) * (to.x - from.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (const double x : crossings) ends.push_back({x, sum - x, height});
  }
}

}  // namespace qsmpc::render
