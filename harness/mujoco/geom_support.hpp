// Support functions of the geoms of a MuJoCo model. For sources that work on MuJoCo models.
#pragma once

#include <functional>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace qsmpc::harness {

/// The support function of a convex set, max over its points p of direction · p, in world axes, m.
using GeomSupport = std::function<double(const Eigen::Vector3d& direction)>;

/// The support function of a geom's convex hull at its pose in `data`; `model` must outlive it. A
/// plane is the rectangle that is drawn of it.
[[nodiscard]] GeomSupport geom_support(const mjModel& model, const mjData& data, int geom);

}  // namespace qsmpc::harness
