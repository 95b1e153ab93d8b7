// Shapes of a MuJoCo vehicle, for what is drawn around MuJoCo's own picture of it.
#pragma once

#include <functional>
#include <vector>

#include <mujoco/mujoco.h>

#include "render/camera.hpp"
#include "render/colour.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

/// Whether the geom is seen and a part of the vehicle, not of the terrain: what is welded to the
/// world stands.
[[nodiscard]] bool is_vehicle(const mjModel& model, int geom);

/// The colour that the file gives the geom.
[[nodiscard]] Colour colour_of(const mjModel& model, int geom);

/// The surface of all parts of the vehicle where `data` has them, as triangles; meshes as boxes.
[[nodiscard]] std::vector<ColouredPoint> vehicle_surface(
    const mjModel& model, const mjData& data, const std::function<Colour(int geom)>& colour);

/// The eight corners (m) of the box about the geom, in its own axes.
[[nodiscard]] std::vector<SpacePoint> box_corners(const mjModel& model, const mjData& data,
                                                  int geom);

/// z (m) of the lowest place that the geom reaches while the last hinge that tilts it turns.
[[nodiscard]] double lowest_place(const mjModel& model, const mjData& data, int geom);

}  // namespace qsmpc::render
