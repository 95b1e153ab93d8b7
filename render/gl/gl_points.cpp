#include "render/gl/gl_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "render/gl/gl_functions.hpp"

namespace qsmpc::render {
namespace {

constexpr float kLargestSquare = 2.5F;        // pixels
constexpr float kLargestSquareOfMany = 4.0F;  // pixels
constexpr std::size_t kMany = 6000;           // points
constexpr float kLargestHexagon = 6.0F;       // pixels
constexpr unsigned kMostSides = 12;

struct Vertex {
  std::array<float, 3> position;
  std::array<unsigned char, 4> colour;
};

unsigned char byte_of(float value) {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): it is not negative.
  return static_cast<unsigned char>(255.0F * std::clamp(value, 0.0F, 1.0F) + 0.5F);
}

std::array<unsigned char, 4> bytes_of(const Colour& colour) {
  return {byte_of(colour.red), byte_of(colour.green), byte_of(colour.blue), byte_of(colour.alpha)};
}

// 1 means one of OpenGL's own points, which are squares.
unsigned sides_of(const GlPoint& point, float largest_square) {
  if (point.size <= largest_square) {
    return 1;
  }
  return point.size <= kLargestHexagon ? 6 : kMostSides;
}

// Corner `side` of a regular polygon about the origin with the area of the unit disc.
PlanarPoint corner(unsigned sides, unsigned side) {
  const double step = 2.0 * std::numbers::pi / sides;
  const double radius = std::sqrt(step / std::sin(step));
  return {radius * std::cos(step * (side + 0.5)), radius * std::sin(step * (side + 0.5))};
}

class PointBatch {
 public:
  explicit PointBatch(const View& view)
      : view_(view), pixel_(2.0 * view.half_height / view.near_plane / view.height) {}

  // Draws `count` points with the same number of sides; squares must also have the same size.
  void draw(const GlPoint* points, std::size_t count, unsigned sides) {
    vertices_.clear();
    corners_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      if (sides == 1) {
        add_vertex(points[i].position, {}, 0.0, points[i].colour);
      } else {
        add_polygon(points[i], sides);
      }
    }
    glVertexPointer(3, GL_FLOAT, sizeof(Vertex), vertices_.front().position.data());
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), vertices_.front().colour.data());
    if (sides == 1) {
      glPointSize(points[0].size);
      glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(vertices_.size()));
    } else {
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(corners_.size()), GL_UNSIGNED_INT,
                     corners_.data());
    }
  }

 private:
  void add_vertex(const SpacePoint& centre, const PlanarPoint& direction, double radius,
                  const Colour& colour) {
    Vertex vertex{.position = {}, .colour = bytes_of(colour)};
    for (std::size_t i = 0; i < 3; ++i) {
      vertex.position[i] = static_cast<float>(
          centre[i] + radius * (direction.x * view_.right[i] + direction.y * view_.up[i]));
    }
    vertices_.push_back(vertex);
  }

  void add_polygon(const GlPoint& point, unsigned sides) {
    const double radius = 0.5 * static_cast<double>(point.size) * pixel_ *
                          camera_coordinates(view_, point.position)[2];
    const auto first = static_cast<unsigned>(vertices_.size());
    for (unsigned side = 0; side < sides; ++side) {
      add_vertex(point.position, unit_corners_[sides == kMostSides ? side : kMostSides + side],
                 radius, point.colour);
    }
    for (unsigned side = 2; side < sides; ++side) {
      corners_.insert(corners_.end(), {first, first + side - 1, first + side});
    }
  }

  static std::vector<PlanarPoint> all_corners() {
    std::vector<PlanarPoint> corners;
    for (const unsigned sides : {kMostSides, 6U}) {
      for (unsigned side = 0; side < sides; ++side) {
        corners.push_back(corner(sides, side));
      }
    }
    return corners;
  }

  const View& view_;
  double pixel_;  // m at 1 m
  std::vector<PlanarPoint> unit_corners_ = all_corners();
  std::vector<Vertex> vertices_;
  std::vector<unsigned> corners_;
};

}  // namespace

void draw_points(const View& view, const std::vector<GlPoint>& points) {
  PointBatch batch(view);
  const float largest_square = points.size() > kMany ? kLargestSquareOfMany : kLargestSquare;
  glEnableClientState(GL_VERTEX_ARRAY);
  glEnableClientState(GL_COLOR_ARRAY);
  for (std::size_t begin = 0; begin < points.size();) {
    const unsigned sides = sides_of(points[begin], largest_square);
    std::size_t end = begin + 1;
    while (end < points.size() && sides_of(points[end], largest_square) == sides &&
           (sides > 1 || points[end].size == points[begin].size)) {
      ++end;
    }
    batch.draw(&points[begin], end - begin, sides);
    begin = end;
  }
  glDisableClientState(GL_VERTEX_ARRAY);
  glDisableClientState(GL_COLOR_ARRAY);
}

}  // namespace qsmpc::render
