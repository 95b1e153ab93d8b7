#include "harness/scenario/mjcf_obstacles.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/errors.hpp"
#include "harness/mujoco/ground_geoms.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kGeoms = "geoms";
constexpr const char* kGroup = "group";
constexpr const char* kHeight = "height";
constexpr int kLastGroup = 5;                  // of MuJoCo's groups
constexpr std::size_t kLongestGeomName = 200;  // bytes

bool can_stand(const GroundGeom& geom) { return geom.is_static && geom.shape.has_value(); }

bool stands_below(const GroundGeom& geom, double height) {
  return geom.highest > 0.0 && geom.lowest < height;
}

std::string called(const GroundGeom& geom) {
  return geom.name.empty() ? "a geom without a name" : geom.name;
}

/// The reason why `geom` cannot be an obstacle below `height`; empty if it can.
std::string why_no_obstacle(const GroundGeom& geom, double height) {
  if (!geom.is_static) return called(geom) + ", which moves";
  if (!geom.shape) return called(geom) + ", " + geom.why_none;
  if (!stands_below(geom, height)) {
    return fmt::format("{}, from {:.3g} to {:.3g} m high", called(geom), geom.lowest, geom.highest);
  }
  // Only obstacles that a scenario can hold, so that the resolved one can be read back.
  Problems problems("");
  const YamlNode tree = parse_yaml(shape_text(*geom.shape), "");
  Section section(tree, problems);
  (void)read_shape(section, tree.keys.front());
  if (problems.empty()) return "";
  const InputError::Where where = problems.sorted().front();
  return fmt::format("{}, {}: {} instead of {}", called(geom), where.key, where.found,
                     where.expected);
}

std::string expected_geoms(double height) {
  const std::string below = height < kInfinity ? fmt::format("{} m", height) : "any height";
  return "geoms fixed to the world that stand between the ground and " + below +
         ": boxes, cylinders, capsules, spheres, ellipsoids, meshes or vertical planes";
}

struct GeomChoice {
  Section& section;
  const std::vector<GroundGeom>& geoms;
  const ObstacleReading& reading;
  double height;
};

std::vector<const GroundGeom*> chosen_by_name(const GeomChoice& choice) {
  std::vector<std::string> known;
  for (const GroundGeom& geom : choice.geoms) {
    if (can_stand(geom) && !geom.name.empty()) known.push_back(geom.name);
  }
  std::vector<const GroundGeom*> chosen;
  const std::vector<std::string> names = choice.section.texts(kGeoms, kLongestGeomName);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto note = [&](const std::string& found, const std::string& expected) {
      choice.reading.problems.add(choice.section.tree(kGeoms)->items[i],
                                  fmt::format("{}.{}", choice.section.path_of(kGeoms), i), found,
                                  expected);
    };
    const auto found = std::ranges::find(choice.geoms, names[i], &GroundGeom::name);
    if (found == choice.geoms.end()) {
      note(names[i], known.empty() ? "nothing, because no static geom has a name"
                                   : expected_names(names[i], known));
    } else if (const std::string why = why_no_obstacle(*found, choice.height); !why.empty()) {
      note(why, expected_geoms(choice.height));
    } else if (std::ranges::find(chosen, &*found) != chosen.end()) {
      note(names[i] + " a second time", "each geom once");
    } else {
      chosen.push_back(&*found);
    }
  }
  return chosen;
}

/// The static geoms of the group; the ground, and geoms above or below, are skipped.
std::vector<const GroundGeom*> chosen_by_group(const GeomChoice& choice) {
  constexpr int kNone = -1;  // an invalid group number is already noted
  const int group = choice.section.whole(kGroup, kNone, {0, kLastGroup});
  std::vector<const GroundGeom*> chosen;
  if (group == kNone) return chosen;
  std::vector<int> others;
  for (const GroundGeom& geom : choice.geoms) {
    const bool is_passed = !geom.is_static || geom.is_ground || !stands_below(geom, choice.height);
    if (is_passed) continue;
    if (geom.group != group) {
      if (std::ranges::find(others, geom.group) == others.end()) others.push_back(geom.group);
      continue;
    }
    const std::string why = why_no_obstacle(geom, choice.height);
    if (why.empty()) {
      chosen.push_back(&geom);
    } else {
      choice.section.note(kGroup, expected_geoms(choice.height), why);
    }
  }
  if (chosen.empty()) {
    std::ranges::sort(others);
    choice.section.note(kGroup,
                        others.empty()
                            ? expected_geoms(choice.height)
                            : fmt::format("a group with such geoms: {}", fmt::join(others, ", ")),
                        fmt::format("no geom that stands in the way in group {}", group));
  }
  return chosen;
}

}  // namespace

std::vector<KeyDescription> mjcf_obstacle_keys() {
  return {
      {.name = kGeoms,
       .values = {list_of_values(TextValue{.longest = kLongestGeomName, .what = "a name"},
                                 {.least = 1, .once = true})},
       .words =
           "names of geoms of `plant.mjcf` that are fixed to the world; either this or `group`",
       .fallback_words = "none"},
      {.name = kGroup,
       .values = {WholeValue{0, kLastGroup}},
       .words = "all geoms of this MuJoCo group that are fixed to the world, except level planes",
       .fallback_words = "none"},
      {.name = kHeight,
       .values = {NumberValue{kPositive}},
       .words = "height below which a geom must begin in order to be an obstacle, {range}",
       .unit = "m",
       .fallback_words = "any"}};
}

std::vector<controller::Obstacle> read_mjcf_obstacles(Section& section, const std::string& mjcf,
                                                      const ObstacleReading& reading) {
  const std::size_t before = reading.problems.size();
  const bool by_name = section.has(kGeoms);
  const bool by_group = section.has(kGroup);
  const bool is_empty = section.list_size(kGeoms) == 0;
  (void)section.tree(kGroup);
  const double height = section.number(kHeight, kInfinity, kPositive);
  section.refuse_unread();
  if (by_name == by_group) {
    section.note_here("geoms, a list of names, or group, a number", by_name ? "both" : "neither");
  }
  if (reading.problems.size() == before && by_name && is_empty) {
    section.note(kGeoms, "at least one name", "an empty list");
  }
  if (reading.problems.size() > before) return {};
  std::vector<controller::Obstacle> obstacles;
  try {
    const std::vector<GroundGeom> geoms = ground_geoms(*load_mujoco_model(mjcf));
    const GeomChoice choice{section, geoms, reading, height};
    for (const GroundGeom* geom : by_name ? chosen_by_name(choice) : chosen_by_group(choice)) {
      obstacles.emplace_back(*geom->shape);
    }
  } catch (const InputError& error) {
    section.note_here("a readable MuJoCo XML file as plant.mjcf", error.what());
  }
  if (obstacles.size() > reading.most) {
    section.note_here(fmt::format("at most {} obstacles including the others", kMostObstacles),
                      fmt::format("{} geoms", obstacles.size()));
  }
  return obstacles;
}

}  // namespace qsmpc::harness
