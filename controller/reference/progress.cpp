#include "controller/reference/progress.hpp"

namespace qsmpc::controller {

std::optional<double> progress_after(const std::optional<PathTarget>& path,
                                     const std::optional<Waypoints>& waypoints,
                                     const models::SystemDescription& system,
                                     const Eigen::Ref<const Eigen::VectorXd>& state,
                                     std::optional<double> before) {
  if (path) {
    return progress_on(*path, {state[system.position_x], state[system.position_y]}, before);
  }
  if (waypoints) {
    return waypoints_passed(*waypoints, system, state, static_cast<int>(before.value_or(0.0)));
  }
  return std::nullopt;
}

}  // namespace qsmpc::controller
