// Plants by name: which vehicle stands for a scenario's system.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// A MuJoCo vehicle that comes with the program, for one system.
struct ShippedPlant {
  std::string name;     ///< as it is given on the command line, e.g. "mujoco_car"
  std::string system;   ///< a name from `qsmpc list systems`
  std::string mjcf;     ///< its file, e.g. "dubins_car.xml"
  std::string summary;  ///< one line
};

/// All of them, by system and from the nearest to the system's equations to the farthest.
[[nodiscard]] const std::vector<ShippedPlant>& shipped_plants();

/// The file of the last of those of a system, which drives unless a scenario names another; empty
/// where there is none.
[[nodiscard]] std::string default_vehicle(const std::string& system);

/// `scenario` with another plant: "analytic", "mujoco" (the scenario's own MuJoCo vehicle, else its
/// system's default), the name of a shipped plant of its system, or the path of an MJCF file,
/// relative to the working folder. Throws InputError on another name, with those that the system
/// has.
[[nodiscard]] Scenario with_plant(Scenario scenario, const std::string& name);

}  // namespace qsmpc::harness
