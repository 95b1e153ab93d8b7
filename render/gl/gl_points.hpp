// Round points facing the camera, many thousands at once.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/colour.hpp"

namespace qsmpc::render {

/// A round point with a diameter of `size` pixels.
struct GlPoint {
  SpacePoint position{};
  float size = 1.0F;
  Colour colour;
};

/// Draws them in the order given, within a FlatDrawing with the same view. Points of up to 2.5
/// pixels (4 where there are more than 6,000) are squares, up to 6 pixels hexagons: the difference
/// is invisible, and many of them cost a fraction of discs.
void draw_points(const View& view, const std::vector<GlPoint>& points);

}  // namespace qsmpc::render
