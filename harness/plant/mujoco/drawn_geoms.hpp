// Excludes purely visual geoms from the collision search. Private to the MuJoCo plant.
#pragma once

#include <mujoco/mujoco.h>

namespace qsmpc::harness {

/// In every step MuJoCo loops over all pairs of geoms of two bodies, including geoms that collide
/// with nothing (contype and conaffinity 0): a vehicle's ornaments cost more time than its wheels.
/// This narrows each body's range of geoms to those that can collide; contacts and their order are
/// unchanged. It does nothing where the file lists contact pairs, or where geoms have drag in a
/// fluid. Only for a model that is not drawn and whose geoms are not looked up by body afterwards.
void leave_out_drawn_geoms(mjModel& model);

}  // namespace qsmpc::harness
