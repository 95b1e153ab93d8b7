// The keys of obstacles, which are in the scenario itself.
#include <fmt/format.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/scenario/obstacle_reader.hpp"

namespace qsmpc::harness {
namespace {

void read_listed(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  reading.scenario.safe_set.obstacles = read_obstacles(
      section, about.name, {.system = reading.system(), .problems = reading.problems});
}

std::optional<std::string> listed_text(const Scenario& scenario,
                                       const models::SystemDescription& system) {
  if (scenario.safe_set.obstacles.empty()) return "[]";
  std::string out;
  for (const controller::Obstacle& obstacle : scenario.safe_set.obstacles) {
    out += "\n    - " + obstacle_text(obstacle, system);
  }
  return out;
}

/// An interval for some of the states, or a shape.
MappingValue obstacle_value() {
  MappingValue value{
      {{.name = "STATE", .family = NameFamily::kStates, .values = {IntervalValue{}}, .words = ""}}};
  for (KeyDescription& shape : shape_keys()) value.keys.push_back(std::move(shape));
  return value;
}

}  // namespace

std::vector<ScenarioKey> obstacle_keys() {
  return {{.about = {.name = "obstacles",
                     .values = {list_of_values(obstacle_value(), {.most = kMostObstacles})},
                     .words = fmt::format(
                         "up to {} obstacles, each a box, a mapping of at least one state to "
                         "`[lower, upper]`, where a state that is not named is not restricted; or "
                         "a `disc`, `ellipse`, `box`, `polygon` or `half_plane` of the plane of "
                         "position",
                         kMostObstacles),
                     .see = "[below](#shapes)",
                     .unit = "of the state; m",
                     .fallback = "[]",
                     .fallback_words = "none"},
           .read = read_listed,
           .write = listed_text}};
}

}  // namespace qsmpc::harness
