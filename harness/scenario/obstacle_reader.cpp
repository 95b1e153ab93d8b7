#include "harness/scenario/obstacle_reader.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/scenario/keys/motion_keys.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/section_values.hpp"

namespace qsmpc::harness {
namespace {

using controller::Obstacle;

/// An obstacle without shapes: intervals of states.
std::optional<Obstacle> read_box(Section& item, const models::SystemDescription& system) {
  const controller::Box whole = controller::unbounded_safe_set(std::ssize(system.states)).bounds;
  NamedIntervals box = read_intervals(item, system.states, {.fallback = whole});
  if (box.any) return Obstacle(std::move(box.box));
  if (item.present() && item.keys().empty()) {
    item.note_here(fmt::format("an interval of at least one of {}, or one of the shapes {}",
                               fmt::join(coordinate_names(system.states), ", "),
                               fmt::join(shape_names(), ", ")),
                   "an obstacle that fills the whole space");
  }
  return std::nullopt;
}

/// Notes keys beside the shape `name`, which must be the only key.
void refuse_others(Section& item, const std::string& name,
                   const std::vector<models::Coordinate>& states) {
  std::vector<std::string> known = shape_names();
  for (const std::string& state : coordinate_names(states)) known.push_back(state);
  for (const std::string& other : item.keys()) {
    if (other == name || std::ranges::find(known, other) == known.end()) continue;
    item.note(other, fmt::format("nothing beside {}: each obstacle is one shape or a box of states",
                                 name));
  }
  item.refuse_unread();
}

std::optional<Obstacle> read_item(Section& item, const ObstacleReading& reading) {
  const std::vector<models::Coordinate>& states = reading.system.states;
  // Registers the keys, so that an error about a misspelt one suggests them.
  for (const std::string& state : coordinate_names(states)) (void)item.tree(state);
  const std::vector<std::string> shapes = named_shapes(item, states);
  const bool moves = item.tree(kMotionKey) != nullptr;
  if (shapes.empty() && moves) {
    item.note(kMotionKey,
              fmt::format("none without one of the shapes {}, because only these can move",
                          fmt::join(shape_names(), ", ")));
  }
  if (shapes.empty()) return read_box(item, reading.system);
  const std::string& name = shapes.front();
  if (!has_plane(reading.system)) {
    item.note(name, fmt::format("intervals of {}, because the system has no position in the plane",
                                fmt::join(coordinate_names(states), ", ")));
    return std::nullopt;
  }
  const std::size_t before = reading.problems.size();
  refuse_others(item, name, states);
  std::optional<controller::PlanarShape> shape = read_shape(item, name);
  if (!shape) return std::nullopt;
  Obstacle obstacle(std::move(*shape));
  if (item.has(kMotionKey)) {
    obstacle.motion = read_motion(item, controller::shape_centre(*obstacle.shape()));
  }
  if (reading.problems.size() > before) return std::nullopt;
  return obstacle;
}

}  // namespace

bool has_plane(const models::SystemDescription& system) {
  return system.position_x >= 0 && system.position_y >= 0;
}

std::vector<Obstacle> read_obstacles(Section& section, const std::string& key,
                                     const ObstacleReading& reading) {
  const std::size_t count = section.list_size(key);
  if (count > reading.most) {
    section.note(key, reading.most == kMostObstacles
                          ? fmt::format("at most {} obstacles", reading.most)
                          : fmt::format("at most {} obstacles, besides those of the scenario",
                                        reading.most));
  }
  std::vector<Obstacle> obstacles;
  for (std::size_t i = 0; i < std::min(count, reading.most); ++i) {
    Section item = section.item(key, i);
    if (!item.present()) continue;  // already noted
    if (std::optional<Obstacle> obstacle = read_item(item, reading)) {
      obstacles.push_back(std::move(*obstacle));
    }
  }
  return obstacles;
}

std::string obstacle_text(const Obstacle& obstacle, const models::SystemDescription& system) {
  if (const controller::Box* box = obstacle.box()) return intervals_text(*box, system.states);
  std::string shape = shape_text(*obstacle.shape());
  if (!obstacle.motion) return shape;
  return fmt::format("{{{}, {}: {}}}", shape.substr(1, shape.size() - 2), kMotionKey,
                     motion_text(*obstacle.motion));
}

}  // namespace qsmpc::harness
