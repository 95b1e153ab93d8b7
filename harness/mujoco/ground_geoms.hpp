// The geoms of a MuJoCo model as they stand on the ground plane: obstacles from an MJCF file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/planar/planar_shape.hpp"

struct mjModel_;

namespace qsmpc::harness {

struct GroundGeom {
  std::string name;        ///< empty where it has none
  int group = 0;           ///< MuJoCo's
  bool is_static = false;  ///< fixed to the world: neither a joint nor a mocap body carries it
  bool is_ground = false;  ///< a level plane
  double lowest = 0.0;     ///< m above the world's origin; −infinity of a vertical plane
  double highest = 0.0;    ///< m; infinite of a vertical plane
  /// Its projection on the ground, where it has one.
  std::optional<controller::PlanarShape> shape{};
  std::string why_none{};  ///< what it is where it has none: "a height field", "a tilted plane"
};

/// Sides of the polygon about what has a round projection that is no disc or ellipse. It reaches
/// beyond that by less than 0.06 % of its size.
inline constexpr int kProjectionSides = 96;

/// All geoms of the model, in its order, at its reference pose. The projections of upright boxes
/// and cylinders, of spheres and of ellipsoids are exact, a vertical plane is a half-plane; of all
/// else it is a convex polygon about the projection: with the corners of boxes and meshes (their
/// hull), or of kProjectionSides where there would be more.
[[nodiscard]] std::vector<GroundGeom> ground_geoms(const mjModel_& model);

}  // namespace qsmpc::harness
