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

/// The key of the scenario that corresponds to `where`, an error in its MuJoCo file.
InputError::Where scenario_place(const InputError::Where& where, const Scenario& scenario,
                                 const std::string& path_or_name,
                                 const std::vector<std::string>& overrides) {
  if (!scenario.plant.mapping) return place_of_key(path_or_name, overrides, "plant.mjcf");
  // "joint NAME": an element that the mapping names and the model does not have.
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
    // Rejects a variation that the plant does not support; any seed will do.
    (void)make_plant(scenario, draw_variation(scenario.disturbance, scenario.seed));
  } catch (const SimulatorError&) {
    // If a drawn vehicle cannot be simulated, that is a fault of its episode, not an invalid file.
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
    const bool is_of_scenario = where.file.empty();  // a key that the plant does not support
    InputError::Where told = is_of_scenario
                                 ? place_of_key(path_or_name, overrides, where.key)
                                 : scenario_place(where, scenario, path_or_name, overrides);
    told.found = is_of_scenario ? where.found : with_place(where);
    told.expected = where.expected;
    return told;
  }
}

}  // namespace qsmpc::harness
