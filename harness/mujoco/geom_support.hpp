// How far the geoms of a MuJoCo model reach in a direction. For sources that work on MuJoCo models.
#pragma once

#include <functional>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace qsmpc::harness {

/// Of a convex set: max over its points p of direction · p, in the world's axes, m.
using GeomSupport = std::function<double(const Eigen::Vector3d& direction)>;

/// Of the convex hull of a geom where `data` has it; `model` must outlive it. A plane is the
/// rectangle that is drawn of it.
[[nodiscard]] GeomSupport geom_support(const mjModel& model, const mjData& data, int geom);

}  // namespace qsmpc::harness
