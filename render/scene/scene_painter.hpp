// Everything in a picture's space but the vehicle: ground, safe set, target, paths, particles.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

/// The smallest rectangle about what is finite in `world`: bounds, obstacles, target; at least 2 m
/// wide and high.
[[nodiscard]] PlanarRectangle world_region(const World& world);

class ScenePainter {
 public:
  /// `region`: where there is something to be seen; the ground's grid reaches well beyond it.
  ScenePainter(World world, const PlanarRectangle& region);

  /// Draws into the picture in which the vehicle, and nothing else, has been drawn.
  /// `vehicle_shadows`: outlines on the ground; `ghost`: triangles as `draw_translucent` takes
  /// them.
  void paint(const Frame& frame, const View& view,
             const std::vector<std::vector<PlanarPoint>>& vehicle_shadows,
             const std::vector<ColouredPoint>& ghost) const;

 private:
  void paint_solids() const;
  void paint_edges(double scale) const;
  void paint_stripes(double scale) const;
  void paint_ground(const View& view) const;
  void paint_shadows(const std::vector<std::vector<PlanarPoint>>& vehicle_shadows) const;
  void paint_target_mark() const;
  void paint_target_post() const;

  World world_;
  PlanarRectangle region_;
  std::vector<PlanarRectangle> walls_;
};

}  // namespace qsmpc::render
