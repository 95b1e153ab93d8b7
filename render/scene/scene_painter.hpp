// Everything in the scene except the vehicle: ground, safe set, target, paths, particles.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"
#include "render/scene/vehicle.hpp"

namespace qsmpc::render {

inline constexpr double kPostHeight = 0.75;  ///< m, of the target's flag

/// The smallest rectangle about everything finite in `world`: bounds, obstacles, target; at least 2
/// m wide and high.
[[nodiscard]] PlanarRectangle world_region(const World& world);

class ScenePainter {
 public:
  /// `region`: the region of interest; the ground's grid extends well beyond it.
  ScenePainter(World world, const PlanarRectangle& region);

  /// Draws into a picture in which only the vehicle has been drawn. Terrain and obstacles in front
  /// of the vehicle do not hide it: it shows through.
  void paint(const Frame& frame, const View& view, const VehicleMarks& vehicle) const;

 private:
  /// Moving obstacles are drawn as well.
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
