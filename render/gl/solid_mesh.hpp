// Simple solids as triangles.
#pragma once

#include <array>
#include <vector>

#include "render/camera.hpp"
#include "render/colour.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

enum class SolidShape { kBox, kCylinder, kEllipsoid };

/// Where a solid is: its centre, its half sides along its own axes, and these axes as a matrix, row
/// by row, whose columns they are. A cylinder's axis is the third one.
struct SolidPlace {
  SpacePoint centre{};
  SpacePoint half_sides{};
  std::array<double, 9> axes{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

/// Appends the solid's surface, three corners a triangle, in `colour`, darker where it is turned
/// away from above.
void append_solid(SolidShape shape, const SolidPlace& place, const Colour& colour,
                  std::vector<ColouredPoint>& corners);

}  // namespace qsmpc::render
