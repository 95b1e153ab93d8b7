// What the planner believes and intends, drawn on the ground: where obstacles that move will be,
// tube, raw points, particles, ellipses, the planned mean.
#pragma once

#include "render/camera.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

/// m above the ground, of all marks on it: paths, particles, ellipses, tube.
inline constexpr double kMarkHeight = 0.01;

/// Pixels, height of the picture for which widths and sizes of marks are stated.
inline constexpr double kReferenceHeight = 720.0;

/// The point of `ellipse` at `angle` (rad): 0 is the end of its first axis.
[[nodiscard]] PlanarPoint on_ellipse(const PlanarEllipse& ellipse, double angle);

/// Draws them within a FlatDrawing with `view`, in the order above. Particles near the vehicle, at
/// `frame.pose` and `vehicle_length` m long, are fainter: it is seen through them.
void paint_belief(const Frame& frame, const View& view, double vehicle_length);

}  // namespace qsmpc::render
