// Plants by name: the vehicles for a scenario's system.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// A MuJoCo vehicle that comes with the program, for one system.
struct ShippedPlant {
  std::string name;     ///< as given on the command line, e.g. "mujoco_car"
  std::string system;   ///< a name from `qsmpc list systems`
  std::string mjcf;     ///< file name, e.g. "dubins_car.xml"
  std::string summary;  ///< one line
};

/// All shipped plants, by system, from the closest to the system's equations to the farthest.
[[nodiscard]] const std::vector<ShippedPlant>& shipped_plants();

/// The file of the last shipped plant of a system, which is the default of its scenarios; empty
/// where there is none.
[[nodiscard]] std::string default_vehicle(const std::string& system);

/// `scenario` with another plant: "analytic", "mujoco" (the scenario's own MuJoCo vehicle, else its
/// system's default), the name of a shipped plant of its system, or the path of an MJCF file,
/// relative to the working folder. Throws InputError on any other name, listing those of the
/// system.
[[nodiscard]] Scenario with_plant(Scenario scenario, const std::string& name);

}  // namespace qsmpc::harness
