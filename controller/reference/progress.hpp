// How far a drive has come that is not simply to a target.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/reference/path_target.hpp"
#include "controller/reference/waypoints.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Progress in `state` (state_dim, finite), after `before` a period earlier, if there was one: arc
/// length on the path, m, or how many waypoints have been passed. Nothing where there are neither.
[[nodiscard]] std::optional<double> progress_after(const std::optional<PathTarget>& path,
                                                   const std::optional<Waypoints>& waypoints,
                                                   const models::SystemDescription& system,
                                                   const Eigen::Ref<const Eigen::VectorXd>& state,
                                                   std::optional<double> before);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
