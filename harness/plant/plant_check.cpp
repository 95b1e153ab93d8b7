#include "harness/plant/plant_check.hpp"

#include <cstddef>

#include "harness/mujoco/mujoco_model.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/plant/plant_variation.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace {

std::string with_place(const InputError::Where& where) {
  InputError::Where told = where;
  told.expected.clear();
  return InputError(told).what();
}

/// The scenario's key that `where`, an error of its MuJoCo file, is about.
InputError::Where scenario_place(const InputError::Where& where, const Scenario& scenario,
                                 const std::string& path_or_name,
                                 const std::vector<std::string>& overrides) {
  if (!scenario.plant.mapping) return place_of_key(path_or_name, overrides, "plant.mjcf");
  // "joint NAME": what the mapping names and the model does not have.
  if (const std::size_t space = where.key.find(' '); space != std::string::npos) {
    const auto place = place_of_element(path_or_name, overrides, where.key.substr(0, space),
                                        where.key.substr(space + 1));
    if (place) return *place;
  }
  return place_of_key(path_or_name, overrides, where.key.empty() ? "plant.mjcf" : "plant");
}

}  // namespace

void try_drawn_vehicle(const Scenario& scenario) {
  if (scenario.plant.kind == "analytic" && !scenario.plant.mjcf.empty()) {
    (void)load_mujoco_model(scenario.plant.mjcf);
  }
}

void try_driven_plant(const Scenario& scenario) {
  (void)make_plant(scenario);
  if (!varies(scenario.disturbance)) return;
  try {
    // Refuses a variation that the plant has nothing for; any seed does.
    (void)make_plant(scenario, draw_variation(scenario.disturbance, scenario.seed));
  } catch (const SimulatorError&) {
    // One vehicle of many that cannot be simulated is an episode's fault, no wrong file.
  }
}

void try_plant(const Scenario& scenario) {
  try_drawn_vehicle(scenario);
  try_driven_plant(scenario);
}

std::optional<InputError::Where> plant_problem(const Scenario& scenario,
                                               const std::string& path_or_name,
                                               const std::vector<std::string>& overrides) {
  try {
    try_plant(scenario);
    return std::nullopt;
  } catch (const InputError& error) {
    const InputError::Where& where = error.where();
    const bool is_of_scenario = where.file.empty();  // a key of it that the plant does not offer
    InputError::Where told = is_of_scenario
                                 ? place_of_key(path_or_name, overrides, where.key)
                                 : scenario_place(where, scenario, path_or_name, overrides);
    told.found = is_of_scenario ? where.found : with_place(where);
    told.expected = where.expected;
    return told;
  }
}

}  // namespace qsmpc::harness
