#include "controller/planning/guide/guided_target.hpp"

#include "controller/planning/cost/angular_target.hpp"
#include "controller/planning/cost/placed_target.hpp"

namespace qsmpc::controller {

std::optional<Guide> make_guide(const models::Dynamics& dynamics, const PlannerSettings& settings) {
  if (!settings.guide) return std::nullopt;
  return Guide(dynamics, settings);
}

void place_guided_target(std::optional<Guide>& guide, const PlannerSettings& settings,
                         const models::SystemDescription& system, const Eigen::VectorXd& state,
                         std::optional<double> progress, QuadraticCost& weights) {
  if (guide) {
    nearest_target(guide->aim(state).state, settings.cost.angles, state, weights.target);
    return;
  }
  place_target(settings, system, state, progress, weights);
}

}  // namespace qsmpc::controller
