// The geoms of a MuJoCo model as seen on the ground plane: obstacles from an MJCF file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/planar/planar_shape.hpp"

struct mjModel_;

namespace qsmpc::harness {

struct GroundGeom {
  std::string name;        ///< empty for an unnamed geom
  int group = 0;           ///< MuJoCo's
  bool is_static = false;  ///< fixed to the world: carried by neither a joint nor a mocap body
  bool is_ground = false;  ///< a level plane
  double lowest = 0.0;     ///< m above the world's origin; −infinity for a vertical plane
  double highest = 0.0;    ///< m; infinite for a vertical plane
  /// Its projection on the ground, where it has one.
  std::optional<controller::PlanarShape> shape{};
  std::string why_none{};  ///< the reason for a missing shape: "a height field", "a tilted plane"
};

/// Number of sides of the polygon around a round projection that is neither a disc nor an ellipse.
/// It extends beyond the projection by less than 0.06 % of its size.
inline constexpr int kProjectionSides = 96;

/// All geoms of the model, in its order, at its reference pose. The projections of upright boxes
/// and cylinders, of spheres and of ellipsoids are exact; a vertical plane is a half-plane. Any
/// other projection is enclosed in a convex polygon: its vertices are the corners of boxes and
/// meshes (of their hull), or it has kProjectionSides sides where there would be more.
[[nodiscard]] std::vector<GroundGeom> ground_geoms(const mjModel_& model);

}  // namespace qsmpc::harness
