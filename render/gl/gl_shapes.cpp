#include "render/gl/gl_shapes.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "render/gl/gl_functions.hpp"

namespace qsmpc::render {
namespace {

constexpr int kCircleSides = 64;
constexpr float kSlopeOffset = 2.0F;
constexpr float kDepthOffset = 400.0F;  // in units of the depth resolution: a few millimetres
// Offsets of prisms, some of which coincide with shapes of the vehicle's file.
constexpr float kBehindSlope = 1.0F;
constexpr float kBehindDepth = 16.0F;
// m. The rasteriser may draw anything for a smooth line without a direction.
constexpr double kLeastSegment = 1e-6;

// Brightness of a box's faces; the sun shines as in the vehicles' files, towards +x and -y.
constexpr float kTopLight = 1.0F;
constexpr float kWestLight = 0.72F;
constexpr float kNorthLight = 0.80F;
constexpr float kEastLight = 0.56F;
constexpr float kSouthLight = 0.62F;

void set_colour(const Colour& colour) {
  glColor4f(colour.red, colour.green, colour.blue, colour.alpha);
}

Colour lit(const Colour& colour, float light) {
  return {colour.red * light, colour.green * light, colour.blue * light, colour.alpha};
}

// Brightness of an upright face with normal (x, y): between those of a box, weighted by its
// components.
float side_light(double x, double y) {
  const auto east = static_cast<float>(x * x / (x * x + y * y));
  return east * (x > 0.0 ? kEastLight : kWestLight) +
         (1.0F - east) * (y > 0.0 ? kNorthLight : kSouthLight);
}

PlanarPoint on_circle(const PlanarPoint& centre, double radius, int side) {
  const double angle = 2.0 * std::numbers::pi * side / kCircleSides;
  return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

void upright_face(const PlanarPoint& from, const PlanarPoint& to, double height,
                  const Colour& colour) {
  // Slightly darker at the foot, so that a box appears to stand on the ground instead of floating.
  constexpr float kFootLight = 0.82F;
  set_colour(lit(colour, kFootLight));
  glVertex3d(from.x, from.y, 0.0);
  glVertex3d(to.x, to.y, 0.0);
  set_colour(colour);
  glVertex3d(to.x, to.y, height);
  glVertex3d(from.x, from.y, height);
}

double separation(const ColouredPoint& a, const ColouredPoint& b) {
  return std::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1],
                    a.position[2] - b.position[2]);
}

void draw_vertices(GLenum primitive, const std::vector<ColouredPoint>& points) {
  glBegin(primitive);
  for (const ColouredPoint& point : points) {
    set_colour(point.colour);
    glVertex3dv(point.position.data());
  }
  glEnd();
}

// A rectangle lying at `height` metres.
void draw_rectangle(const PlanarRectangle& area, double height, const Colour& colour) {
  set_colour(colour);
  glBegin(GL_QUADS);
  glVertex3d(area.x_lower, area.y_lower, height);
  glVertex3d(area.x_upper, area.y_lower, height);
  glVertex3d(area.x_upper, area.y_upper, height);
  glVertex3d(area.x_lower, area.y_upper, height);
  glEnd();
}

// A convex polygon lying at `height` metres.
void draw_level_polygon(const std::vector<PlanarPoint>& corners, double height,
                        const Colour& colour) {
  set_colour(colour);
  glBegin(GL_POLYGON);
  for (const PlanarPoint& corner : corners) {
    glVertex3d(corner.x, corner.y, height);
  }
  glEnd();
}

void load_view(const View& view) {
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glFrustum(-view.half_width, view.half_width, -view.half_height, view.half_height, view.near_plane,
            view.far_plane);
  std::array<double, 16> matrix{};
  const std::array<SpacePoint, 3> axes{
      view.right, view.up, SpacePoint{-view.forward[0], -view.forward[1], -view.forward[2]}};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      matrix[4 * column + row] = axes[row][column];
      matrix[12 + row] -= axes[row][column] * view.position[column];
    }
  }
  matrix[15] = 1.0;
  glMatrixMode(GL_MODELVIEW);
  glLoadMatrixd(matrix.data());
}

}  // namespace

FlatDrawing::FlatDrawing(const View& view) {
  glPushAttrib(GL_ALL_ATTRIB_BITS);
  glMatrixMode(GL_PROJECTION);
  glPushMatrix();
  glMatrixMode(GL_MODELVIEW);
  glPushMatrix();
  load_view(view);
  glViewport(0, 0, view.width, view.height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_LIGHTING);
  glDisable(GL_COLOR_MATERIAL);
  glDisable(GL_TEXTURE_2D);
  glDisable(GL_TEXTURE_CUBE_MAP);
  glDisable(GL_CULL_FACE);
  glDisable(GL_FOG);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glShadeModel(GL_SMOOTH);
  glEnable(GL_LINE_SMOOTH);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

FlatDrawing::~FlatDrawing() {
  glMatrixMode(GL_PROJECTION);
  glPopMatrix();
  glMatrixMode(GL_MODELVIEW);
  glPopMatrix();
  glPopAttrib();
}

void write_depth(bool on) { glDepthMask(on ? GL_TRUE : GL_FALSE); }

void begin_single_coverage() {
  glClearStencil(0);
  glClear(GL_STENCIL_BUFFER_BIT);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 0, 1);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
}

void end_single_coverage() { glDisable(GL_STENCIL_TEST); }

void draw_box(const PlanarRectangle& area, double height, const Colour& colour) {
  const PlanarPoint south_west{area.x_lower, area.y_lower};
  const PlanarPoint south_east{area.x_upper, area.y_lower};
  const PlanarPoint north_east{area.x_upper, area.y_upper};
  const PlanarPoint north_west{area.x_lower, area.y_upper};
  draw_rectangle(area, height, lit(colour, kTopLight));
  glBegin(GL_QUADS);
  upright_face(south_west, south_east, height, lit(colour, kSouthLight));
  upright_face(south_east, north_east, height, lit(colour, kEastLight));
  upright_face(north_east, north_west, height, lit(colour, kNorthLight));
  upright_face(north_west, south_west, height, lit(colour, kWestLight));
  glEnd();
}

void draw_prism(const Prism& prism, double height, const Colour& colour) {
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kBehindSlope, kBehindDepth);
  for (const std::vector<PlanarPoint>& piece : prism.pieces) {
    draw_level_polygon(piece, height, lit(colour, kTopLight));
  }
  glBegin(GL_QUADS);
  for (std::size_t i = 0; i < prism.outline.size(); ++i) {
    const PlanarPoint& from = prism.outline[i];
    const PlanarPoint& to = prism.outline[(i + 1) % prism.outline.size()];
    if (from.x == to.x && from.y == to.y) continue;
    upright_face(from, to, height, lit(colour, side_light(to.y - from.y, from.x - to.x)));
  }
  glEnd();
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void draw_polygon(const std::vector<PlanarPoint>& corners, const Colour& colour) {
  draw_level_polygon(corners, 0.0, colour);
}

void draw_ring(const PlanarPoint& centre, double inner, double outer, const Colour& colour) {
  set_colour(colour);
  glBegin(GL_TRIANGLE_STRIP);
  for (int side = 0; side <= kCircleSides; ++side) {
    const PlanarPoint near = on_circle(centre, inner, side);
    const PlanarPoint far = on_circle(centre, outer, side);
    glVertex3d(near.x, near.y, 0.0);
    glVertex3d(far.x, far.y, 0.0);
  }
  glEnd();
}

void draw_tube(const PlanarPoint& centre, double radius, double height, const Colour& bottom,
               const Colour& top) {
  glBegin(GL_TRIANGLE_STRIP);
  for (int side = 0; side <= kCircleSides; ++side) {
    const PlanarPoint point = on_circle(centre, radius, side);
    set_colour(bottom);
    glVertex3d(point.x, point.y, 0.0);
    set_colour(top);
    glVertex3d(point.x, point.y, height);
  }
  glEnd();
}

void draw_triangle(const SpacePoint& a, const SpacePoint& b, const SpacePoint& c,
                   const Colour& colour) {
  set_colour(colour);
  glBegin(GL_TRIANGLES);
  glVertex3dv(a.data());
  glVertex3dv(b.data());
  glVertex3dv(c.data());
  glEnd();
}

void draw_segments(const std::vector<SpacePoint>& ends, double width, const Colour& colour) {
  glLineWidth(static_cast<float>(width));
  set_colour(colour);
  glBegin(GL_LINES);
  for (const SpacePoint& end : ends) {
    glVertex3dv(end.data());
  }
  glEnd();
}

void draw_path(const std::vector<PlanarPoint>& points, double height, double width,
               const Colour& colour) {
  glLineWidth(static_cast<float>(width));
  set_colour(colour);
  glBegin(GL_LINE_STRIP);
  const PlanarPoint* last = nullptr;
  for (const PlanarPoint& point : points) {
    if (last != nullptr && std::hypot(point.x - last->x, point.y - last->y) < kLeastSegment) {
      continue;
    }
    glVertex3d(point.x, point.y, height);
    last = &point;
  }
  glEnd();
}

void draw_coloured_path(const std::vector<ColouredPoint>& points, double width) {
  glLineWidth(static_cast<float>(width));
  std::vector<ColouredPoint> distinct;
  for (const ColouredPoint& point : points) {
    if (distinct.empty() || separation(distinct.back(), point) >= kLeastSegment) {
      distinct.push_back(point);
    }
  }
  draw_vertices(GL_LINE_STRIP, distinct);
}

void draw_band(const std::vector<ColouredPoint>& edges) { draw_vertices(GL_TRIANGLE_STRIP, edges); }

void draw_translucent(const std::vector<ColouredPoint>& corners) {
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kSlopeOffset, kDepthOffset);
  // Depth only first: then only the front is blended, once.
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  write_depth(true);
  draw_vertices(GL_TRIANGLES, corners);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  write_depth(false);
  draw_vertices(GL_TRIANGLES, corners);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void begin_beside(const std::vector<ColouredPoint>& corners) {
  glClearStencil(0);
  glClear(GL_STENCIL_BUFFER_BIT);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 1);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-kSlopeOffset, -kDepthOffset);
  draw_vertices(GL_TRIANGLES, corners);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glStencilFunc(GL_EQUAL, 0, 1);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void end_beside() { glDisable(GL_STENCIL_TEST); }

void draw_hidden(const std::vector<ColouredPoint>& corners) {
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  glDepthFunc(GL_GREATER);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-kSlopeOffset, -kDepthOffset);
  draw_vertices(GL_TRIANGLES, corners);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthFunc(GL_LEQUAL);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

}  // namespace qsmpc::render
