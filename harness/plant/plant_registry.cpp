#include "harness/plant/plant_registry.hpp"

#include <algorithm>
#include <functional>
#include <initializer_list>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/plant/analytic_plant.hpp"
#include "harness/plant/mujoco/mujoco_plant.hpp"
#include "harness/scenario/model_dynamics.hpp"

namespace qsmpc::harness {
namespace {

struct PlantMaker {
  PlantEntry entry;
  std::function<std::unique_ptr<Plant>(const Scenario&, const PlantVariation&)> make;
};

/// Multiplies the parameters that `names` lists; rejects a factor that would change none.
void vary(models::ParameterMap& parameters, const char* what, double factor,
          std::initializer_list<const char*> names) {
  if (factor == 1.0) return;
  bool any = false;
  for (const char* name : names) {
    const auto found = parameters.find(name);
    if (found == parameters.end()) continue;
    found->second *= factor;
    any = true;
  }
  if (any) return;
  throw InputError({.key = std::string("disturbance.") + what,
                    .found = "a deviation above 0",
                    .expected = "0, because the system has no such constant, or a MuJoCo plant"});
}

std::unique_ptr<Plant> make_analytic(const Scenario& scenario, const PlantVariation& variation) {
  if (scenario.disturbance.kind != "state") {
    throw InputError({.key = "disturbance.kind",
                      .found = scenario.disturbance.kind,
                      .expected = "state, because an analytic plant has no body to push"});
  }
  if (scenario.plant.solid) {
    throw InputError({.key = "plant.solid",
                      .found = "true",
                      .expected = "false, because an analytic plant has no body to stop"});
  }
  Scenario::Model model = scenario.model;
  models::ParameterMap& parameters = model.parameters;
  vary(parameters, "friction", variation.friction, {"front_tyre_stiffness", "rear_tyre_stiffness"});
  vary(parameters, "mass", variation.mass, {"mass", "yaw_inertia", "cart_mass", "pole_mass"});
  vary(parameters, "wheelbase", variation.wheelbase, {"front_axle_distance", "rear_axle_distance"});
  return make_analytic_plant(make_model(model, scenario.time_step), scenario.time_step);
}

std::unique_ptr<Plant> make_mujoco(const Scenario& scenario, const PlantVariation& variation) {
  const bool pushed = scenario.disturbance.kind == "force";
  return make_mujoco_plant(
      {.mjcf = scenario.plant.mjcf,
       .control_period = scenario.time_step,
       .system = system_of(scenario),
       .parameters = scenario.model.parameters,
       .mapping = scenario.plant.mapping,
       .time_step = scenario.plant.time_step,
       .variation = variation,
       .solid = scenario.plant.solid ? std::optional(scenario.safe_set) : std::nullopt,
       .force_covariance = pushed ? scenario.disturbance.covariance : Eigen::MatrixXd()});
}

const std::vector<PlantMaker>& makers() {
  static const std::vector<PlantMaker> table{
      {{.name = "analytic", .summary = "the planner's own model, disturbed"}, make_analytic},
      {{.name = "mujoco", .summary = "a MuJoCo vehicle with its low-level loops"}, make_mujoco}};
  return table;
}

}  // namespace

const std::vector<PlantEntry>& plants() {
  static const std::vector<PlantEntry> entries = [] {
    std::vector<PlantEntry> list;
    for (const PlantMaker& maker : makers()) list.push_back(maker.entry);
    return list;
  }();
  return entries;
}

std::unique_ptr<Plant> make_plant(const Scenario& scenario, const PlantVariation& variation) {
  const std::string& kind = scenario.plant.kind;
  for (const PlantMaker& maker : makers()) {
    if (maker.entry.name == kind) return maker.make(scenario, variation);
  }
  std::string known;
  for (const PlantEntry& entry : plants()) known += (known.empty() ? "" : ", ") + entry.name;
  throw InputError({.key = "plant.kind", .found = kind, .expected = "one of " + known});
}

std::string plant_digest(const Scenario& scenario) {
  return scenario.plant.kind == "mujoco" ? mujoco_model_digest(scenario.plant.mjcf) : "";
}

}  // namespace qsmpc::harness
