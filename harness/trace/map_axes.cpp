#include "harness/trace/map_axes.hpp"

#include <algorithm>
#include <vector>

namespace qsmpc::harness {

bool has_position(const models::SystemDescription& system) {
  return system.position_x >= 0 && system.position_y >= 0;
}

std::optional<MapAxes> map_axes(const models::SystemDescription& system) {
  if (has_position(system)) return MapAxes{.x = system.position_x, .y = system.position_y};
  const std::vector<models::Coordinate>& states = system.states;
  const auto index = [&states](const auto& found) {
    return static_cast<int>(found - states.begin());
  };
  const auto position = std::find_if(states.begin(), states.end(),
                                     [](const models::Coordinate& s) { return s.unit == "m"; });
  if (position == states.end() || states.size() < 2) return std::nullopt;
  const auto angle = std::find_if(states.begin(), states.end(),
                                  [](const models::Coordinate& s) { return s.unit == "rad"; });
  const int x = index(position);
  const int other = x == 0 ? 1 : 0;
  return MapAxes{.x = x, .y = angle == states.end() ? other : index(angle), .is_plane = false};
}

}  // namespace qsmpc::harness
