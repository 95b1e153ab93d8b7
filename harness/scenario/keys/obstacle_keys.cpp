// The keys of obstacles: in the scenario itself, in a separate file, and in the plant's model.
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/motion_keys.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/scenario/mjcf_obstacles.hpp"
#include "harness/scenario/obstacle_file.hpp"
#include "harness/scenario/obstacle_reader.hpp"
#include "harness/scenario/section_values.hpp"

namespace qsmpc::harness {
namespace {

/// The number of obstacles that may still be added.
ObstacleReading reading_of_more(ScenarioReading& reading) {
  return {.system = reading.system(),
          .problems = reading.problems,
          .most = kMostObstacles - reading.scenario.safe_set.obstacles.size()};
}

void append_obstacles(ScenarioReading& reading, std::vector<controller::Obstacle> more) {
  std::vector<controller::Obstacle>& obstacles = reading.scenario.safe_set.obstacles;
  obstacles.insert(obstacles.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
}

void read_listed(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  append_obstacles(reading, read_obstacles(section, about.name, reading_of_more(reading)));
}

void read_from_file(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  if (!section.has(about.name)) return (void)section.tree(about.name);
  const std::optional<std::string> path =
      named_file(section, about.name, reading.lookup.folder,
                 "the path of a file with obstacles, relative to the scenario's folder or, with "
                 "--set, to the working folder");
  if (path) append_obstacles(reading, read_obstacle_file(*path, reading_of_more(reading)));
}

void read_from_model(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  Section choice = section.section(about.name);
  if (!choice.present()) return;
  const std::string& mjcf = reading.scenario.plant.mjcf;
  if (!has_plane(reading.system())) {
    section.note(about.name, "none, because the system has no position in the plane");
  } else if (mjcf.empty()) {
    section.note(about.name, "none, because there is no plant.mjcf");
  } else {
    append_obstacles(reading, read_mjcf_obstacles(choice, mjcf, reading_of_more(reading)));
  }
}

/// The resolved scenario contains the obstacles themselves.
std::optional<std::string> not_written(const Scenario& /*scenario*/,
                                       const models::SystemDescription& /*system*/) {
  return std::nullopt;
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

/// Intervals for some of the states, or a shape.
MappingValue obstacle_value() {
  MappingValue value{
      {{.name = "STATE", .family = NameFamily::kStates, .values = {IntervalValue{}}, .words = ""}}};
  for (KeyDescription& shape : shape_keys()) value.keys.push_back(std::move(shape));
  value.keys.push_back(motion_key());
  return value;
}

}  // namespace

std::vector<ScenarioKey> obstacle_keys() {
  return {{.about = {.name = "obstacles",
                     .values = {list_of_values(obstacle_value(), {.most = kMostObstacles})},
                     .words = fmt::format(
                         "up to {} obstacles, each either a box, a mapping of at least one state "
                         "to `[lower, upper]` in which states not named are unrestricted, or a "
                         "`disc`, `ellipse`, `box`, `polygon` or `half_plane` in the plane of "
                         "position, which may have a `motion`",
                         kMostObstacles),
                     .see = "[below](#shapes)",
                     .unit = "of the state; m",
                     .fallback = "[]",
                     .fallback_words = "none"},
           .read = read_listed,
           .write = listed_text},
          {.about = {.name = "obstacles_from_file",
                     .values = {TextValue{.what = "a path"}},
                     .words = "path of a YAML or JSON file with more of them, absolute or relative "
                              "to the scenario's folder (with `--set`, otherwise to the working "
                              "folder): a list as above, or GeoJSON in m",
                     .see = "[below](#obstacles-from-a-file)",
                     .fallback_words = "none"},
           .read = read_from_file,
           .write = not_written},
          {.about = {.name = "obstacles_from_mjcf",
                     .values = {MappingValue{mjcf_obstacle_keys()}},
                     .words = "a mapping with `geoms` or `group`: more of them, the areas that "
                              "these geoms of `plant.mjcf` cover on the ground",
                     .see = "[below](#obstacles-from-the-plants-model)",
                     .fallback_words = "none"},
           .read = read_from_model,
           .write = not_written}};
}

}  // namespace qsmpc::harness
