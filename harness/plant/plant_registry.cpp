#include "harness/plant/plant_registry.hpp"

#include <algorithm>
#include <functional>

#include "harness/errors.hpp"
#include "harness/plant/analytic_plant.hpp"
#include "harness/plant/mujoco_plant.hpp"

namespace qsmpc {
namespace {

struct PlantMaker {
  PlantEntry entry;
  std::function<std::unique_ptr<Plant>(const Scenario&)> make;
};

std::unique_ptr<Plant> make_analytic(const Scenario& scenario) {
  const Scenario::Model& model = scenario.model;
  return make_analytic_plant(make_dynamics(model.system, model.parameters, scenario.time_step),
                             scenario.time_step);
}

std::unique_ptr<Plant> make_mujoco(const Scenario& scenario) {
  return make_mujoco_plant(
      {.mjcf = scenario.plant.mjcf,
       .control_period = scenario.time_step,
       .mapping = mujoco_mapping(scenario.model.system, scenario.model.parameters)});
}

const std::vector<PlantMaker>& makers() {
  static const std::vector<PlantMaker> table{
      {{.name = "analytic", .summary = "the planner's own model, disturbed"}, make_analytic},
      {{.name = "mujoco", .summary = "a MuJoCo vehicle with low-level loops, disturbed by kicks"},
       make_mujoco}};
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

std::unique_ptr<Plant> make_plant(const Scenario& scenario) {
  const std::string& kind = scenario.plant.kind;
  for (const PlantMaker& maker : makers()) {
    if (maker.entry.name == kind) return maker.make(scenario);
  }
  std::string known;
  for (const PlantEntry& entry : plants()) known += (known.empty() ? "" : ", ") + entry.name;
  throw InputError({.key = "plant.kind", .found = kind, .expected = "one of " + known});
}

}  // namespace qsmpc
