// Shapes of a MuJoCo vehicle, for drawing around MuJoCo's own picture of it.
#pragma once

#include <functional>
#include <vector>

#include <mujoco/mujoco.h>

#include "render/camera.hpp"
#include "render/colour.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

/// Whether the geom is visible and part of the vehicle, not of the terrain: geoms welded to the
/// world are terrain.
[[nodiscard]] bool is_vehicle(const mjModel& model, int geom);

/// The colour of the geom in the file.
[[nodiscard]] Colour colour_of(const mjModel& model, int geom);

/// The surface of all parts of the vehicle, placed as in `data`, as triangles; meshes as boxes.
[[nodiscard]] std::vector<ColouredPoint> vehicle_surface(
    const mjModel& model, const mjData& data, const std::function<Colour(int geom)>& colour);

/// The eight corners (m) of the box about the geom, aligned with the geom's axes.
[[nodiscard]] std::vector<SpacePoint> box_corners(const mjModel& model, const mjData& data,
                                                  int geom);

/// z (m) of the lowest point that the geom can reach while the last hinge that tilts it rotates.
[[nodiscard]] double lowest_place(const mjModel& model, const mjData& data, int geom);

}  // namespace qsmpc::render
