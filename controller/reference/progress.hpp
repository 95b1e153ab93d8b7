// Progress of a drive along a path or over waypoints.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/reference/path_target.hpp"
#include "controller/reference/waypoints.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Progress in `state` (state_dim, finite), given the progress `before` of a period earlier, if
/// any: arc length on the path, m, or the number of waypoints passed. Empty without either.
[[nodiscard]] std::optional<double> progress_after(const std::optional<PathTarget>& path,
                                                   const std::optional<Waypoints>& waypoints,
                                                   const models::SystemDescription& system,
                                                   const Eigen::Ref<const Eigen::VectorXd>& state,
                                                   std::optional<double> before);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
