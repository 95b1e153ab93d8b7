// Simple shapes drawn with OpenGL into the current context; no lighting, colours as given.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/colour.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

/// Sets up flat drawing with `view` until it is destroyed, then restores OpenGL's state: blending
/// and depth test on, lighting and textures off.
class FlatDrawing {
 public:
  explicit FlatDrawing(const View& view);
  ~FlatDrawing();
  FlatDrawing(const FlatDrawing&) = delete;
  FlatDrawing& operator=(const FlatDrawing&) = delete;
};

/// Sets whether the following shapes hide later ones behind them.
void write_depth(bool on);

/// Between these two calls each pixel is drawn only once, however often it is covered.
void begin_single_coverage();
void end_single_coverage();

/// An upright box from the ground, its sides shaded as if the sun stood in the south-west.
void draw_box(const PlanarRectangle& area, double height, const Colour& colour);

/// An upright prism from the ground, shaded likewise. Where its surface coincides with something
/// drawn before, the latter is in front.
void draw_prism(const Prism& prism, double height, const Colour& colour);

/// A convex polygon lying on the ground.
void draw_polygon(const std::vector<PlanarPoint>& corners, const Colour& colour);

/// A ring lying on the ground; a disc if the inner radius is 0.
void draw_ring(const PlanarPoint& centre, double inner, double outer, const Colour& colour);

/// The side of an upright cylinder, with a colour gradient from `bottom` to `top`.
void draw_tube(const PlanarPoint& centre, double radius, double height, const Colour& bottom,
               const Colour& top);

/// A triangle in space.
void draw_triangle(const SpacePoint& a, const SpacePoint& b, const SpacePoint& c,
                   const Colour& colour);

/// Separate lines, `width` pixels wide, between the points 0 and 1, 2 and 3, …
void draw_segments(const std::vector<SpacePoint>& ends, double width, const Colour& colour);

/// One line through all points at `height` metres, `width` pixels wide.
void draw_path(const std::vector<PlanarPoint>& points, double height, double width,
               const Colour& colour);

/// A corner of a shape with its own colour.
struct ColouredPoint {
  SpacePoint position{};
  Colour colour;
};

/// One line through all points, `width` pixels wide, with interpolated colours.
void draw_coloured_path(const std::vector<ColouredPoint>& points, double width);

/// A band between the points 0, 2, 4, … and the points 1, 3, 5, …, with interpolated colours.
void draw_band(const std::vector<ColouredPoint>& edges);

/// Triangles in space, three points each, as a translucent solid: its own parts behind its front
/// are not visible, and where it touches something drawn before, the latter is in front.
void draw_translucent(const std::vector<ColouredPoint>& corners);

/// Between these two calls nothing is drawn where the solid of these triangles is visible.
void begin_beside(const std::vector<ColouredPoint>& corners);
void end_beside();

/// Draws the hidden part of the solid given to `begin_beside`, as if seen through glass; of
/// overlapping triangles, the first. Call it once between those two calls, as the last drawing.
void draw_hidden(const std::vector<ColouredPoint>& corners);

}  // namespace qsmpc::render
