// Everything in a picture's space but the vehicle: ground, safe set, target, paths, particles.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"
#include "render/scene/vehicle.hpp"

namespace qsmpc::render {

inline constexpr double kPostHeight = 0.75;  ///< m, of the target's flag

/// The smallest rectangle about what is finite in `world`: bounds, obstacles, target; at least 2 m
/// wide and high.
[[nodiscard]] PlanarRectangle world_region(const World& world);

class ScenePainter {
 public:
  /// `region`: where there is something to be seen; the ground's grid reaches well beyond it.
  ScenePainter(World world, const PlanarRectangle& region);

  /// Draws into the picture in which the vehicle, and nothing else, has been drawn. Terrain and
  /// obstacles do not hide the vehicle: where they stand before it, it shines through.
  void paint(const Frame& frame, const View& view, const VehicleMarks& vehicle) const;

 private:
  /// Obstacles that move are among what is drawn of them.
  void paint_solids(const std::vector<Prism>& moving) const;
  void paint_edges(const std::vector<Prism>& moving, double scale) const;
  void paint_stripes(const std::vector<Prism>& moving, double scale) const;
  void paint_ground(const View& view) const;
  void paint_shadows(const std::vector<Prism>& moving,
                     const std::vector<std::vector<PlanarPoint>>& vehicle_shadows) const;
  void paint_road(double scale) const;
  void paint_target_mark() const;
  void paint_waypoints(std::size_t passed) const;
  void paint_target_post() const;

  World world_;
  PlanarRectangle region_;
  PlanarRectangle ground_;
  std::vector<PlanarRectangle> walls_;
};

}  // namespace qsmpc::render
