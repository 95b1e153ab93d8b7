#include "render/gl/solid_mesh.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace qsmpc::render {
namespace {

constexpr int kTurns = 16;  // corners about the third axis
constexpr int kLayers = 8;  // along it, for an ellipsoid
constexpr float kLeastLight = 0.62F;

// Corner `turn` of layer `layer` of the shape with half side lengths 1.
SpacePoint unit_corner(SolidShape shape, int layer, int layers, int turn, int turns) {
  const double angle = 2.0 * std::numbers::pi * (turn + 0.5) / turns;
  if (shape == SolidShape::kEllipsoid) {
    const double rise = std::numbers::pi * (static_cast<double>(layer) / layers - 0.5);
    return {std::cos(rise) * std::cos(angle), std::cos(rise) * std::sin(angle), std::sin(rise)};
  }
  // The two middle layers form the side; the outer two shrink to points and form the lids.
  const bool lid = layer == 0 || layer == layers;
  const double radius = lid ? 0.0 : shape == SolidShape::kBox ? std::numbers::sqrt2 : 1.0;
  return {radius * std::cos(angle), radius * std::sin(angle), 2 * layer < layers ? -1.0 : 1.0};
}

SpacePoint placed(const SolidPlace& place, const SpacePoint& unit) {
  SpacePoint point = place.centre;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[row] += place.axes[3 * row + axis] * place.half_sides[axis] * unit[axis];
    }
  }
  return point;
}

// z of the unit normal of the triangle; 0 if it has no area.
double upward(const SpacePoint& a, const SpacePoint& b, const SpacePoint& c) {
  const SpacePoint u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const SpacePoint v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const SpacePoint normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  return length > 0.0 ? normal[2] / length : 0.0;
}

void append_triangle(const SpacePoint& a, const SpacePoint& b, const SpacePoint& c,
                     const Colour& colour, std::vector<ColouredPoint>& corners) {
  const auto share = static_cast<float>(0.5 * (1.0 + upward(a, b, c)));
  const float light = kLeastLight + (1.0F - kLeastLight) * share;
  const Colour lit{colour.red * light, colour.green * light, colour.blue * light, colour.alpha};
  corners.insert(corners.end(), {{a, lit}, {b, lit}, {c, lit}});
}

}  // namespace

void append_solid(SolidShape shape, const SolidPlace& place, const Colour& colour,
                  std::vector<ColouredPoint>& corners) {
  const int turns = shape == SolidShape::kBox ? 4 : kTurns;
  const int layers = shape == SolidShape::kEllipsoid ? kLayers : 3;
  const auto corner = [&](int layer, int turn) {
    return placed(place, unit_corner(shape, layer, layers, turn, turns));
  };
  for (int layer = 0; layer < layers; ++layer) {
    for (int turn = 0; turn < turns; ++turn) {
      const SpacePoint a = corner(layer, turn);
      const SpacePoint b = corner(layer, turn + 1);
      const SpacePoint c = corner(layer + 1, turn + 1);
      const SpacePoint d = corner(layer + 1, turn);
      if (layer > 0) append_triangle(a, b, c, colour, corners);
      if (layer + 1 < layers) append_triangle(a, c, d, colour, corners);
    }
  }
}

}  // namespace qsmpc::render
