#include "harness/plant/plant_check.hpp"

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

}  // namespace

void try_plant(const Scenario& scenario) {
  (void)make_plant(scenario);
  if (!varies(scenario.disturbance)) return;
  try {
    // Refuses a variation that the plant has nothing for; any seed does.
    (void)make_plant(scenario, draw_variation(scenario.disturbance, scenario.seed));
  } catch (const SimulatorError&) {
    // One vehicle of many that cannot be simulated is an episode's fault, no wrong file.
  }
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
    const std::string model_key = scenario.plant.mapping ? "plant" : "plant.mjcf";
    InputError::Where told =
        place_of_key(path_or_name, overrides, is_of_scenario ? where.key : model_key);
    told.key = is_of_scenario ? where.key : model_key;
    told.found = is_of_scenario ? where.found : with_place(where);
    told.expected = where.expected;
    return told;
  }
}

}  // namespace qsmpc::harness
