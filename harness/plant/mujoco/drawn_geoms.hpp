// Geoms that are only drawn, and what they cost a simulation. Private to the MuJoCo plant.
#pragma once

#include <mujoco/mujoco.h>

namespace qsmpc::harness {

/// MuJoCo looks through all pairs of geoms of two bodies in every step, those with them that touch
/// nothing (contype and conaffinity 0): a vehicle's ornaments take longer than its wheels. Here the
/// ranges of geoms that its bodies have for that are narrowed to what can touch; no contact
/// changes, nor their order. Where geoms may touch by pairs that the file names, or drag in a
/// fluid, nothing is done. Only for a model that draws nothing, and of which nobody asks for the
/// geoms of a body from then on.
void leave_out_drawn_geoms(mjModel& model);

}  // namespace qsmpc::harness
