// Flat, anti-aliased drawing onto an image: what the head-up display is made of.
#pragma once

#include <string_view>
#include <vector>

#include "render/colour.hpp"
#include "render/frame.hpp"
#include "render/hud/font.hpp"

namespace qsmpc {

/// A place in an image: pixels from its upper left corner, x to the right and y down.
struct PixelPoint {
  double x = 0.0;
  double y = 0.0;
};

struct PixelRectangle {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// Blends `colour` over the rectangle, with corners rounded to `radius` (pixels). What lies outside
/// of the image is cut off, here and below.
void fill_rectangle(Image& image, const PixelRectangle& area, const Colour& colour,
                    double radius = 0.0);

/// A filled circle.
void fill_circle(Image& image, const PixelPoint& centre, double radius, const Colour& colour);

/// A line `width` pixels thick through `points`, which run from left to right. A point that is not
/// finite interrupts it.
void draw_graph(Image& image, const std::vector<PixelPoint>& points, double width,
                const Colour& colour);

/// One line of ASCII text; `pen` is the left end of its baseline.
void draw_text(Image& image, const Font& font, std::string_view text, const PixelPoint& pen,
               const Colour& colour);

}  // namespace qsmpc
