#include "render/scene/ground_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "render/gl/gl_functions.hpp"

namespace qsmpc::render {
namespace {

// A point on the ground and its distance along the line of sight.
struct SightedPoint {
  SpacePoint at{};
  double depth = 0.0;
};
using Outline = std::vector<SightedPoint>;

SightedPoint sighted(const View& view, const SpacePoint& point) {
  return {point, camera_coordinates(view, point)[2]};
}

// The point of the line from `a` to `b` at `depth`; symmetric in both, so that neighbours meet.
SightedPoint crossing(SightedPoint a, SightedPoint b, double depth) {
  if (a.depth > b.depth) std::swap(a, b);
  const double share = (depth - a.depth) / (b.depth - a.depth);
  SightedPoint point{.depth = depth};
  for (std::size_t i = 0; i < 3; ++i) point.at[i] = a.at[i] + share * (b.at[i] - a.at[i]);
  return point;
}

// The part of a convex outline whose depth is at least (or at most) `depth`.
Outline part_of(const Outline& outline, double depth, bool beyond) {
  const auto belongs = [&](const SightedPoint& p) {
    return beyond ? p.depth >= depth : p.depth <= depth;
  };
  Outline part;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const SightedPoint& from = outline[i];
    const SightedPoint& to = outline[(i + 1) % outline.size()];
    if (belongs(from)) part.push_back(from);
    if (belongs(from) != belongs(to)) part.push_back(crossing(from, to, depth));
  }
  return part;
}

void fogged_vertex(const SightedPoint& point, const Colour& colour, const Fog& fog) {
  const double share = std::clamp((point.depth - fog.begin) / (fog.end - fog.begin), 0.0, 1.0);
  const Colour mixed = mix(colour, fog.colour.with_alpha(colour.alpha), static_cast<float>(share));
  glColor4f(mixed.red, mixed.green, mixed.blue, mixed.alpha);
  glVertex3dv(point.at.data());
}

void draw_part(const Outline& part, const Colour& colour, const Fog& fog) {
  if (part.size() < 3) return;
  glBegin(GL_POLYGON);
  for (const SightedPoint& point : part) fogged_vertex(point, colour, fog);
  glEnd();
}

}  // namespace

void draw_ground(const View& view, const PlanarRectangle& area, const Colour& colour,
                 const Fog& fog) {
  if (!(area.x_upper > area.x_lower && area.y_upper > area.y_lower)) return;
  const Outline all{sighted(view, {area.x_lower, area.y_lower, 0.0}),
                    sighted(view, {area.x_upper, area.y_lower, 0.0}),
                    sighted(view, {area.x_upper, area.y_upper, 0.0}),
                    sighted(view, {area.x_lower, area.y_upper, 0.0})};
  glDisable(GL_BLEND);
  draw_part(part_of(all, fog.begin, false), colour, fog);
  draw_part(part_of(part_of(all, fog.begin, true), fog.end, false), colour, fog);
  draw_part(part_of(all, fog.end, true), colour, fog);
  glEnable(GL_BLEND);
}

void draw_ground_around(const View& view, const PlanarRectangle& inner,
                        const PlanarRectangle& outer, const Colour& colour, const Fog& fog) {
  const std::array<double, 4> x{outer.x_lower, inner.x_lower, inner.x_upper, outer.x_upper};
  const std::array<double, 4> y{outer.y_lower, inner.y_lower, inner.y_upper, outer.y_upper};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (i == 1 && j == 1) continue;
      draw_ground(view, {x[i], x[i + 1], y[j], y[j + 1]}, colour, fog);
    }
  }
}

void draw_fading_segments(const View& view, const std::vector<SpacePoint>& ends, double width,
                          const Colour& colour, const Fog& fog) {
  glLineWidth(static_cast<float>(width));
  glBegin(GL_LINES);
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    SightedPoint near = sighted(view, ends[i]);
    SightedPoint far = sighted(view, ends[i + 1]);
    if (near.depth > far.depth) std::swap(near, far);
    for (const double depth : {fog.begin, fog.end}) {
      if (near.depth < depth && depth < far.depth) {
        const SightedPoint cut = crossing(near, far, depth);
        fogged_vertex(near, colour, fog);
        fogged_vertex(cut, colour, fog);
        near = cut;
      }
    }
    // Segments in the colour of the horizon are invisible against it.
    if (near.depth >= fog.end) continue;
    fogged_vertex(near, colour, fog);
    fogged_vertex(far, colour, fog);
  }
  glEnd();
}

void draw_sky(const View& view, double reach, const Colour& top, const Colour& bottom) {
  // Rays that fall by at least `fall` per metre along the line of sight meet the ground within
  // reach; the bound is for the longest rays, through the picture's corners.
  const double across = view.half_width / view.near_plane;
  const double upwards = view.half_height / view.near_plane;
  const double longest = std::hypot(1.0, across, upwards);
  const double fall = view.position[2] * longest / reach;
  double lower = -1.0;  // lower end of the sky, from -1 (the picture's lower edge) to 1
  constexpr double kLevel = 1e-9;
  if (view.up[2] > kLevel) {
    lower = std::clamp((-view.forward[2] - fall) / (view.up[2] * upwards), -1.0, 1.0);
  } else if (-view.forward[2] >= fall) {
    return;  // looking down: only ground is visible
  }
  const Colour edge = mix(bottom, top, static_cast<float>(0.5 * (lower + 1.0)));
  glMatrixMode(GL_PROJECTION);
  glPushMatrix();
  glLoadIdentity();
  glMatrixMode(GL_MODELVIEW);
  glPushMatrix();
  glLoadIdentity();
  glDisable(GL_BLEND);
  glBegin(GL_QUADS);
  glColor4f(edge.red, edge.green, edge.blue, 1.0F);
  glVertex3d(-1.0, lower, 1.0);
  glVertex3d(1.0, lower, 1.0);
  glColor4f(top.red, top.green, top.blue, 1.0F);
  glVertex3d(1.0, 1.0, 1.0);
  glVertex3d(-1.0, 1.0, 1.0);
  glEnd();
  glEnable(GL_BLEND);
  glPopMatrix();
  glMatrixMode(GL_PROJECTION);
  glPopMatrix();
  glMatrixMode(GL_MODELVIEW);
}

}  // namespace qsmpc::render
