// Simple solids as triangles.
#pragma once

#include <array>
#include <vector>

#include "render/camera.hpp"
#include "render/colour.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

enum class SolidShape { kBox, kCylinder, kEllipsoid };

/// The place of a solid: its centre, its half side lengths along its own axes, and the matrix with
/// these axes as columns, stored row by row. A cylinder's axis is the third one.
struct SolidPlace {
  SpacePoint centre{};
  SpacePoint half_sides{};
  std::array<double, 9> axes{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

/// Appends the solid's surface in `colour`, three corners per triangle, darker where it does not
/// face upwards.
void append_solid(SolidShape shape, const SolidPlace& place, const Colour& colour,
                  std::vector<ColouredPoint>& corners);

}  // namespace qsmpc::render
