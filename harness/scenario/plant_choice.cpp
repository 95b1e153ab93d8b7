#include "harness/scenario/plant_choice.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/shipped_files.hpp"

namespace qsmpc::harness {
namespace {

std::vector<std::string> plant_names(const std::string& system) {
  std::vector<std::string> names{"analytic", "mujoco"};
  for (const ShippedPlant& plant : shipped_plants()) {
    if (plant.system == system) names.push_back(plant.name);
  }
  return names;
}

}  // namespace

const std::vector<ShippedPlant>& shipped_plants() {
  static const std::vector<ShippedPlant> plants{
      {.name = "mujoco_planar",
       .system = "dubins",
       .mjcf = "dubins_planar.xml",
       .summary = "the Dubins car built from MuJoCo joints, its speeds held by servos"},
      {.name = "mujoco_car",
       .system = "dubins",
       .mjcf = "dubins_car.xml",
       .summary = "a small car on four wheels that steers, rolls and slips"},
      {.name = "mujoco_planar",
       .system = "dubins_rk4",
       .mjcf = "dubins_planar.xml",
       .summary = "the Dubins car built from MuJoCo joints, its speeds held by servos"},
      {.name = "mujoco_car",
       .system = "dubins_rk4",
       .mjcf = "dubins_car.xml",
       .summary = "a small car on four wheels that steers, rolls and slips"},
      {.name = "mujoco_planar",
       .system = "bicycle",
       .mjcf = "bicycle_planar.xml",
       .summary = "the bicycle built from MuJoCo joints, driven by its tyre forces"},
      {.name = "mujoco_car",
       .system = "bicycle",
       .mjcf = "bicycle_car.xml",
       .summary = "a full-size car on four wheels with tyres that slip"},
      {.name = "mujoco_slider",
       .system = "double_integrator",
       .mjcf = "double_integrator_slider.xml",
       .summary = "a mass on a rail"},
      {.name = "mujoco_cart_pole",
       .system = "cart_pole",
       .mjcf = "cart_pole.xml",
       .summary = "a cart on a rail with a hinged pole"},
      {.name = "mujoco_slider",
       .system = "point_mass",
       .mjcf = "point_mass.xml",
       .summary = "a mass on two crossed rails"}};
  return plants;
}

std::string default_vehicle(const std::string& system) {
  std::string farthest;
  for (const ShippedPlant& plant : shipped_plants()) {
    if (plant.system == system) farthest = plant.mjcf;
  }
  return farthest;
}

Scenario with_plant(Scenario scenario, const std::string& name) {
  const std::string& system = scenario.model.system;
  Scenario::Plant& plant = scenario.plant;
  if (name == "analytic") {
    plant.kind = "analytic";
    return scenario;
  }
  std::string mjcf = name == "mujoco" ? plant.mjcf : "";
  if (name == "mujoco" && mjcf.empty()) mjcf = find_mjcf(default_vehicle(system), "");
  const auto shipped = std::ranges::find_if(shipped_plants(), [&](const ShippedPlant& entry) {
    return entry.name == name && entry.system == system;
  });
  if (shipped != shipped_plants().end()) mjcf = find_mjcf(shipped->mjcf, "");
  if (mjcf.empty() && std::filesystem::path(name).extension() == ".xml") {
    mjcf = find_mjcf(name, std::filesystem::current_path().string());
  }
  if (mjcf.empty()) {
    throw InputError(
        {.key = "--plant",
         .found = name,
         .expected = "an existing MJCF file, or " + expected_names(name, plant_names(system))});
  }
  if (mjcf != plant.mjcf) {
    // These refer to the previous file.
    plant.mapping.reset();
    plant.time_step.reset();
  }
  plant.kind = "mujoco";
  plant.mjcf = std::move(mjcf);
  return scenario;
}

}  // namespace qsmpc::harness
