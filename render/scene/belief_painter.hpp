// The planner's beliefs and intentions, drawn on the ground: forecasts of moving obstacles, tube,
// raw points, particles, ellipses and the planned mean.
#pragma once

#include "render/camera.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

/// Height above the ground of all marks on it (paths, particles, ellipses, tube), m.
inline constexpr double kMarkHeight = 0.01;

/// Picture height for which widths and sizes of marks are specified, pixels.
inline constexpr double kReferenceHeight = 720.0;

/// The point of `ellipse` at `angle` (rad): 0 is at the end of its first axis.
[[nodiscard]] PlanarPoint on_ellipse(const PlanarEllipse& ellipse, double angle);

/// Draws these within a FlatDrawing with `view`, in the order above. Particles near the vehicle, at
/// `frame.pose` and `vehicle_length` m long, are fainter, so that it remains visible.
void paint_belief(const Frame& frame, const View& view, double vehicle_length);

}  // namespace qsmpc::render
