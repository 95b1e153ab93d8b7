// Round points that face the camera, many thousands of them at once.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/colour.hpp"

namespace qsmpc::render {

/// A round point of `size` pixels across.
struct GlPoint {
  SpacePoint position{};
  float size = 1.0F;
  Colour colour;
};

/// Draws them in the order given, within a FlatDrawing with the same view. Points of up to 2.5
/// pixels (4 where there are more than 6,000) are squares, up to 6 pixels hexagons: nobody sees the
/// difference, and many of them cost a fraction of what discs do.
void draw_points(const View& view, const std::vector<GlPoint>& points);

}  // namespace qsmpc::render
