// The keys of the map: the safe set and the target.
#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/regions/standing.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/section_values.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

controller::Box unbounded_box(const ScenarioReading& reading) {
  return controller::unbounded_safe_set(std::ssize(reading.system().states)).bounds;
}

void read_bounds(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  Section bounds = section.section(about.name);
  reading.scenario.safe_set.bounds =
      read_intervals(bounds, reading.system().states, {.fallback = unbounded_box(reading)}).box;
}

void read_angles(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const models::SystemDescription& system = reading.system();
  std::vector<std::string> known;
  for (const models::Coordinate& state : system.states) {
    if (state.is_angle) known.push_back(state.name);
  }
  std::vector<int>& angles = reading.scenario.target.angles;
  for (const std::string& name : section.texts(about.name, kLongestName)) {
    const int index = system.state_index(name);
    if (std::ranges::find(known, name) == known.end()) {
      section.note(about.name,
                   known.empty() ? "no names, because no state of the system is an angle"
                                 : "states that are angles, " + expected_names(name, known),
                   name);
    } else if (std::ranges::find(angles, index) != angles.end()) {
      section.note(about.name, "each state once", name + " a second time");
    } else {
      angles.push_back(index);
    }
  }
}

std::optional<std::string> angles_text(const Scenario& scenario,
                                       const models::SystemDescription& system) {
  std::vector<std::string> names;
  names.reserve(scenario.target.angles.size());
  for (const int index : scenario.target.angles) {
    names.push_back(system.states[static_cast<std::size_t>(index)].name);
  }
  return fmt::format("[{}]", fmt::join(names, ", "));
}

void read_target_state(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const std::vector<models::Coordinate>& states = reading.system().states;
  const Eigen::Index size = std::ssize(states);
  Eigen::VectorXd& state = reading.scenario.target.state;
  state.setZero(size);
  const char* const other = section.has("path") ? "path" : "waypoints";
  if (!section.has(other)) {
    section.require(about.name, fmt::format("{} numbers, [{}]", size,
                                            fmt::join(coordinate_names(states), ", ")));
  } else if (section.has(about.name)) {
    section.note(about.name, fmt::format("nothing, because there is target.{}", other));
  }
  if (const auto given = section.vector(about.name, size)) state = *given;
}

std::optional<std::string> target_state_text(const Scenario& scenario,
                                             const models::SystemDescription& /*system*/) {
  if (scenario.target.has_path() || scenario.target.has_waypoints()) return std::nullopt;
  return yaml_list(scenario.target.state);
}

ScenarioKey angles_key() {
  return {
      .about = {.name = "angles",
                .values = {list_of_values(SystemNameValue{NameFamily::kAngles}, {.once = true})},
                .words = "list of angle states whose target is taken modulo 2π, e.g. `[heading]`: "
                         "headings a full turn apart then cost the same",
                .see = "[below](#angles)",
                .fallback = "[]",
                .fallback_words = "`[]`: as many turns as `target.state` says"},
      .read = read_angles,
      .write = angles_text};
}

}  // namespace

ScenarioKey safe_set_key() {
  ScenarioKey key{
      .about = {.name = "safe_set"},
      .keys = {{.about = {.name = "bounds",
                          .values = {MappingValue{{{.name = "STATE",
                                                    .family = NameFamily::kStates,
                                                    .values = {IntervalValue{}},
                                                    .words = "`[lower, upper]`",
                                                    .unit = "of the state",
                                                    .fallback_words = "no bound"}}}}},
                .read = read_bounds,
                .write =
                    [](const Scenario& scenario, const models::SystemDescription& system) {
                      return std::optional(intervals_text(scenario.safe_set.bounds, system.states));
                    }}},
      .after = ReadAfter::kSystem,
      .table = "map"};
  for (ScenarioKey& obstacles : obstacle_keys()) key.keys.push_back(std::move(obstacles));
  return key;
}

ScenarioKey target_key() {
  ScenarioKey key{
      .about = {.name = "target", .required = true},
      .keys = {{.about = {.name = "state",
                          .values = {VectorValue{}},
                          .words = "*n* numbers; must be safe",
                          .fallback_words = "required without `path` and `waypoints`"},
                .read = read_target_state,
                .check =
                    [](const ScenarioReading& reading, Section& section) {
                      const Scenario::Target& target = reading.scenario.target;
                      if (target.has_path() || target.has_waypoints()) return;
                      check_safe(reading, section, "state", target.state,
                                 controller::standing(reading.scenario.safe_set));
                    },
                .write = target_state_text},
               {.about = {.name = "radius",
                          .values = {NumberValue{kPositive}},
                          .words = "distance at which the target counts as reached, {range}, in "
                                   "the plane of position (over all states for a system without "
                                   "one)",
                          .unit = "m"},
                .member = [](Scenario& scenario) -> double& { return scenario.target.radius; }},
               angles_key()},
      .after = ReadAfter::kSystem,
      .table = "map"};
  for (ScenarioKey& of_path : path_keys()) key.keys.push_back(std::move(of_path));
  for (ScenarioKey& of_route : waypoint_keys()) key.keys.push_back(std::move(of_route));
  return key;
}

}  // namespace qsmpc::harness
