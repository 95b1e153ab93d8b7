#include "harness/scenario/keys/motion_keys.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/listed_rows.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

using models::IntendedWay;
using models::ObstacleMotion;

constexpr NumberRange kVelocities{.least = -models::kFastestWay, .most = models::kFastestWay};
constexpr NumberRange kDeviations{.least = 0.0, .most = 1e6};
constexpr NumberRange kMemories{.least = 1e-3, .most = 1e6};
constexpr NumberRange kSpeeds{.least = 1e-6, .most = models::kFastestWay};

constexpr const char* kWayKeys[] = {"velocity", "path", "route", "speed"};

/// A pair (along, across) of motion values: a key that also takes one number for both.
struct PairKey {
  const char* name;
  const char* words;
  const char* unit;
  Eigen::Vector2d ObstacleMotion::*member;
};
constexpr PairKey kPairs[] = {
    {"start_deviation", "standard deviation of its initial position", "m",
     &ObstacleMotion::start_deviation},
    {"speed_deviation", "standard deviation of its velocity from the way's", "m/s",
     &ObstacleMotion::speed_deviation},
    {"returns_in", "time in which it corrects 63 % of a deviation from the way; 0: never", "s",
     &ObstacleMotion::returns_in},
    {"covariance_rate", "covariance rate of a random walk about the way", "m²/s",
     &ObstacleMotion::covariance_rate},
};

Eigen::Vector2d read_pair(Section& motion, const char* key) {
  if (!motion.has(key) || motion.holds_text(key)) {
    return Eigen::Vector2d::Constant(motion.number(key, 0.0, kDeviations));
  }
  const std::optional<Eigen::VectorXd> pair = motion.vector(key, 2);
  if (!pair) return Eigen::Vector2d::Zero();
  if ((pair->array() < kDeviations.least).any() || (pair->array() > kDeviations.most).any()) {
    motion.note(key, "two numbers from 0 to 1e6, along the way and across", yaml_list(*pair));
  }
  return *pair;
}

/// The rows under `key`, with `columns` numbers each.
std::optional<Eigen::MatrixXd> read_way_rows(Section& section, const char* key, std::size_t columns,
                                             const char* row) {
  const auto read =
      read_rows(section, key, {.widths = {columns}, .words = row, .most = kMostWayPlaces});
  if (!read) return std::nullopt;
  Eigen::MatrixXd rows = matrix_of(*read);
  if (rows.cwiseAbs().maxCoeff() > kShapePlaces.most) {
    section.note(key, "numbers of at most 1e7", fmt::format("{:g}", rows.cwiseAbs().maxCoeff()));
    return std::nullopt;
  }
  return rows;
}

void read_route(Section& section, const Eigen::Vector2d& centre, IntendedWay& way) {
  section.require("speed", "a speed in m/s for the route");
  const double speed = section.number("speed", 1.0, kSpeeds);
  const auto rows = read_way_rows(section, "route", 2, "[x, y]");
  if (!rows) return;
  Eigen::Matrix2Xd places(2, rows->rows() + 1);
  places << centre, rows->transpose();
  way.points = models::way_along(places, speed).points;
}

void read_path(Section& section, IntendedWay& way) {
  const auto rows = read_way_rows(section, "path", 3, "[time, x, y]");
  if (!rows) return;
  for (const auto& row : rows->rowwise()) {
    way.points.push_back({.time = row[0], .place = row.tail<2>().transpose()});
  }
}

/// The values of one way, read from `section`.
IntendedWay read_way(Section& section, const Eigen::Vector2d& centre) {
  // Registers the keys, so that an error about a misspelt one suggests them.
  for (const char* key : kWayKeys) (void)section.tree(key);
  IntendedWay way{.points = {{.place = centre}}};
  if (section.has("route") && section.has("path")) {
    section.note("route", "no route beside a path: only one of them can say where it goes");
  } else if (section.has("route")) {
    read_route(section, centre, way);
  } else if (section.has("path")) {
    read_path(section, way);
  }
  if (section.has("speed") && !section.has("route")) {
    section.note("speed", "none without a route; velocity sets how it continues");
  }
  if (!section.has("velocity")) return way;
  if (const auto velocity = section.vector("velocity", 2)) way.onward = *velocity;
  return way;
}

std::vector<IntendedWay> read_ways(Section& motion, const Eigen::Vector2d& centre) {
  (void)motion.tree("ways");
  if (!motion.has("ways")) return {read_way(motion, centre)};
  for (const char* key : kWayKeys) {
    if (motion.has(key)) motion.note(key, "none beside ways, each of which has its own");
  }
  const std::size_t count = motion.list_size("ways");
  if (count < 1 || count > kMostWays) {
    motion.note("ways", fmt::format("1 to {} ways", kMostWays));
    return {};
  }
  std::vector<IntendedWay> ways;
  for (std::size_t i = 0; i < count; ++i) {
    Section item = motion.item("ways", i);
    if (!item.present()) continue;  // already noted
    item.require("probability", "its probability");
    const double probability =
        item.number("probability", 1.0, {.least = 0.0, .most = 1.0, .above_least = true});
    ways.push_back(read_way(item, centre));
    ways.back().probability = probability;
    item.refuse_unread();
  }
  return ways;
}

KeyDescription rows_key(const char* name, std::size_t columns, const char* words,
                        const char* unit) {
  const VectorValue row{.size = Dimension::kAny, .length = columns, .range = kShapePlaces};
  return {.name = name,
          .values = {list_of_values(row, {.least = 1, .most = kMostWayPlaces})},
          .words = words,
          .unit = unit};
}

std::vector<KeyDescription> way_keys() {
  return {{.name = "velocity",
           .values = {VectorValue{.size = Dimension::kAny, .length = 2, .range = kVelocities}},
           .words = "velocity of a straight motion; after a path or a route, the velocity with "
                    "which it continues",
           .unit = "m/s",
           .fallback = "[0, 0]"},
          rows_key("path", 3,
                   "`[time, x, y]`: positions of its centre with their times, with straight lines "
                   "between them; at time 0 it is where its shape is defined",
                   "s, m"),
          rows_key("route", 2, "`[x, y]`: positions that its centre passes at the `speed`", "m"),
          {.name = "speed",
           .values = {NumberValue{kSpeeds}},
           .words = "speed along the `route`",
           .unit = "m/s"}};
}

std::string way_text(const IntendedWay& way) {
  std::string text;
  if (way.points.size() > 1) {
    Eigen::MatrixXd rows(std::ssize(way.points) - 1, 3);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const models::TimedPlace& point = way.points[static_cast<std::size_t>(i) + 1];
      rows.row(i) << point.time, point.place.transpose();
    }
    text = fmt::format("path: {}, ", yaml_rows(rows));
  }
  return text + fmt::format("velocity: {}", yaml_list(way.onward));
}

std::string ways_text(const std::vector<IntendedWay>& ways) {
  if (ways.size() == 1) return way_text(ways.front());
  std::string text;
  for (const IntendedWay& way : ways) {
    text += fmt::format("{}{{probability: {}, {}}}", text.empty() ? "" : ", ",
                        yaml_number(way.probability), way_text(way));
  }
  return fmt::format("ways: [{}]", text);
}

}  // namespace

KeyDescription motion_key() {
  std::vector<KeyDescription> keys = way_keys();
  std::vector<KeyDescription> one = way_keys();
  one.insert(one.begin(),
             {.name = "probability",
              .values = {NumberValue{{.least = 0.0, .most = 1.0, .above_least = true}}},
              .words = "probability that it takes this way; all of them add up to 1",
              .required = true});
  keys.push_back({.name = "ways",
                  .values = {list_of_values(MappingValue{one}, {.least = 1, .most = kMostWays})},
                  .words = "instead of one way, several ways, of which it takes one"});
  for (const PairKey& pair : kPairs) {
    keys.push_back(
        {.name = pair.name,
         .values = {NumberValue{kDeviations},
                    VectorValue{.size = Dimension::kAny, .length = 2, .range = kDeviations}},
         .words = fmt::format("{}; `[along, across]` the way, or one number for both", pair.words),
         .unit = pair.unit,
         .fallback = "0"});
  }
  keys.push_back({.name = "memory",
                  .values = {NumberValue{kMemories}},
                  .words = "correlation time of its velocity's deviation",
                  .unit = "s",
                  .fallback = "1"});
  keys.push_back(
      {.name = "seen_deviation",
       .values = {NumberValue{kDeviations}},
       .words = "standard deviation of each coordinate of its position as the planner observes it",
       .unit = "m",
       .fallback = "0"});
  keys.push_back({.name = "turns",
                  .values = {FlagValue{}},
                  .words = "whether it turns about its centre with the direction of its way",
                  .fallback = "false"});
  keys.push_back(
      {.name = "yields",
       .values = {NumberValue{kDeviations}},
       .words =
           "it waits while the vehicle is closer than this; certificates do not account for it",
       .unit = "m",
       .fallback = "0"});
  return {.name = kMotionKey,
          .values = {MappingValue{std::move(keys)}},
          .words = "how a shape moves; only beside a shape",
          .see = "[below](#obstacles-that-move)"};
}

std::optional<ObstacleMotion> read_motion(Section& obstacle, const Eigen::Vector2d& centre) {
  Section section = obstacle.section(kMotionKey);
  if (!section.present()) return std::nullopt;
  if (section.keys().empty()) {
    obstacle.note(kMotionKey, "a motion, e.g. with a velocity or a route, or no such key",
                  "an empty mapping");
    return std::nullopt;
  }
  ObstacleMotion motion;
  motion.ways = read_ways(section, centre);
  for (const PairKey& pair : kPairs) motion.*pair.member = read_pair(section, pair.name);
  motion.memory = section.number("memory", motion.memory, kMemories);
  motion.seen_deviation = section.number("seen_deviation", 0.0, kDeviations);
  motion.turns = section.flag("turns", false);
  motion.yields = section.number("yields", 0.0, kDeviations);
  section.refuse_unread();
  if (motion.ways.empty()) return std::nullopt;
  try {
    models::check_obstacle_motion(motion);
  } catch (const std::invalid_argument& refusal) {
    section.note_here(refusal.what(), "another motion");
    return std::nullopt;
  }
  return motion;
}

std::string motion_text(const ObstacleMotion& motion) {
  std::string text = ways_text(motion.ways);
  for (const PairKey& pair : kPairs) {
    text += fmt::format(", {}: {}", pair.name, yaml_list(motion.*pair.member));
  }
  return fmt::format("{{{}, memory: {}, seen_deviation: {}, turns: {}, yields: {}}}", text,
                     yaml_number(motion.memory), yaml_number(motion.seen_deviation), motion.turns,
                     yaml_number(motion.yields));
}

}  // namespace qsmpc::harness
