#include "harness/assembly/chosen_points.hpp"

#include <memory>

#include "harness/assembly/assembly.hpp"
#include "harness/scenario/outside_controllers.hpp"

namespace qsmpc::harness {

std::optional<controller::PointsChoice> choose_points(Scenario& scenario) {
  Scenario::Quantisation& points = scenario.controller.quantisation;
  if (points.tolerance <= 0.0) return std::nullopt;
  std::optional<controller::PointsChoice> choice;
  if (!is_outside(scenario.controller) && driving_kind(scenario.controller) == "quantised") {
    const std::unique_ptr<const models::Dynamics> model = model_of(scenario);
    choice = controller::choose_points(
        *model,
        {.mean = scenario.initial_state.mean, .covariance = scenario.initial_state.covariance},
        {.tolerance = points.tolerance}, planner_settings(scenario));
    points.state = choice->state_points;
    points.compressed = choice->compressed_points;
  }
  points.tolerance = 0.0;
  return choice;
}

Scenario with_chosen_points(Scenario scenario) {
  (void)choose_points(scenario);
  return scenario;
}

}  // namespace qsmpc::harness
