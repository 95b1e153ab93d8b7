#include "controller/planning/cost/placed_target.hpp"

#include "controller/planning/cost/angular_target.hpp"

namespace qsmpc::controller {

void place_target(const PlannerSettings& settings, const models::SystemDescription& system,
                  const Eigen::VectorXd& state, std::optional<double> progress,
                  QuadraticCost& weights) {
  if (settings.waypoints) {
    nearest_target(settings.waypoints->next(progress.value_or(0.0)), settings.cost.angles, state,
                   weights.target);
    return;
  }
  if (!settings.path) {
    nearest_target(settings.cost.target, settings.cost.angles, state, weights.target);
    return;
  }
  const PathTarget& path = *settings.path;
  const Eigen::Vector2d position(state[system.position_x], state[system.position_y]);
  weights.stage_targets.resize(state.size(), settings.horizon + 1);
  path_targets(path, system, state, progress ? *progress : progress_on(path, position, {}),
               weights.stage_targets);
  weights.target = weights.stage_targets.rightCols<1>();
}

}  // namespace qsmpc::controller
