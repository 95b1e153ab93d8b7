#include "harness/trace/drawn_vehicle.hpp"

#include <algorithm>

#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/shipped_files.hpp"

namespace qsmpc::harness {

int drawn_x(const models::SystemDescription& system) {
  if (system.position_x >= 0 || system.position_y >= 0) return system.position_x;
  const auto position = std::find_if(system.states.begin(), system.states.end(),
                                     [](const models::Coordinate& s) { return s.unit == "m"; });
  return position == system.states.end() ? -1 : static_cast<int>(position - system.states.begin());
}

bool is_on_rail(const models::SystemDescription& system) {
  return system.position_x < 0 && system.position_y < 0 && drawn_x(system) >= 0;
}

std::string drawn_vehicle(const EpisodeView& view) {
  const std::string& own = view.scenario().plant.mjcf;
  if (!own.empty() || !is_on_rail(view.system())) return own;
  const std::string shipped = default_vehicle(view.system().name);
  return shipped.empty() ? "" : find_mjcf(shipped, "");
}

}  // namespace qsmpc::harness
