// The keys of a target that is a path: in the scenario itself or in a separate file.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/listed_rows.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/obstacle_reader.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/scenario/path_file.hpp"
#include "harness/scenario/section_values.hpp"
#include "harness/scenario/target_course.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kPathKey = "path";
constexpr const char* kClosedKey = "closed";
constexpr const char* kSpeedKey = "speed";
constexpr const char* kAccelerationKey = "acceleration";
constexpr const char* kTopSpeedKey = "top_speed";
constexpr const char* kLapsKey = "laps";
constexpr const char* kFast = "fast";
constexpr const char* kModelSpeed = "speed";  // a parameter of models that have one speed
constexpr NumberRange kPathSpeeds{.least = 0.0, .most = 1000.0, .above_least = true};

bool has_path(const Scenario& scenario) { return scenario.target.has_path(); }

/// Stores the rows that were read, without a last point that repeats the first, and derives the
/// course and the road from them.
void take_rows(ScenarioReading& reading, Section& section, PathRows read, const RowNote& note) {
  Scenario& scenario = reading.scenario;
  TargetPath& path = scenario.target.path;
  Eigen::MatrixXd& rows = read.rows;
  path.closed = section.flag(kClosedKey, comes_back(rows));
  const bool repeats = path.closed && rows.rows() > 1 &&
                       rows.row(0).head<2>() == rows.row(rows.rows() - 1).head<2>();
  if (repeats) rows.conservativeResize(rows.rows() - 1, Eigen::NoChange);
  if (!check_path_rows(rows, path.closed, note)) return;
  path.rows = std::move(rows);
  if (path.laps != 1 && !path.closed) {
    section.note(kLapsKey, "1, because the path is not closed");
  }
  // The course and the road may depend on values with problems elsewhere.
  if (!reading.problems.empty()) return;
  const models::SystemDescription& system = reading.system();
  const Eigen::VectorXd& mean = scenario.initial_state.mean;
  scenario.target.course =
      course_of(path, {.position = {mean[system.position_x], mean[system.position_y]},
                       .time_step = scenario.time_step});
  const controller::PathTarget& course = *scenario.target.course;
  scenario.target.state.resize(mean.size());
  controller::path_targets(course, system, mean, course.end, scenario.target.state);
  scenario.safe_set.road = road_of(path, course, scenario.safe_set.body, note);
}

void read_listed_path(ScenarioReading& reading, Section& section) {
  const auto rows = read_rows(section, kPathKey,
                              {.widths = {2, 4},
                               .words = "[x, y], or [x, y, right width, left width]",
                               .name = "points",
                               .least = 0,
                               .most = kMostPathRows});
  if (!rows) return;
  take_rows(reading, section, {.rows = matrix_of(*rows)},
            [&](Eigen::Index row, std::string found, const std::string& expected) {
              section.note_item(kPathKey, static_cast<std::size_t>(row), expected,
                                std::move(found));
            });
}

void read_path_of_file(ScenarioReading& reading, Section& section) {
  const std::optional<std::string> file =
      named_file(section, kPathKey, reading.lookup.folder,
                 "a list of points, or the path of a text file of points, relative to the "
                 "scenario's folder or, with --set, to the working folder");
  if (!file) return;
  std::optional<PathRows> rows = read_path_file(*file, reading.problems);
  if (!rows) return;
  const std::vector<int> lines = rows->lines;
  take_rows(reading, section, std::move(*rows),
            [&](Eigen::Index row, std::string found, std::string expected) {
              reading.problems.add({.file = *file,
                                    .line = row < std::ssize(lines) ? lines[row] : 0,
                                    .found = std::move(found),
                                    .expected = std::move(expected)});
            });
}

void read_path(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  if (!section.has(about.name)) {
    (void)section.tree(about.name);
    for (const char* key : {kClosedKey, kSpeedKey, kAccelerationKey, kTopSpeedKey, kLapsKey}) {
      if (section.has(key)) section.note(key, "a target.path that it applies to");
    }
    return;
  }
  if (!has_plane(reading.system())) {
    return section.note(about.name, "none, because the system has no position in the plane");
  }
  if (section.tree(about.name)->kind == YamlNode::Kind::kList) {
    read_listed_path(reading, section);
  } else {
    read_path_of_file(reading, section);
  }
}

/// Does nothing: `path` reads this key.
void read_with_path(ScenarioReading& /*reading*/, Section& section, const KeyDescription& about) {
  (void)section.tree(about.name);
}

void read_speed(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  if (!section.has(kPathKey)) return (void)section.tree(about.name);
  TargetPath& path = reading.scenario.target.path;
  const models::ParameterMap& parameters = reading.scenario.model.parameters;
  const auto own = parameters.find(kModelSpeed);
  const YamlNode* given = section.tree(about.name);
  path.fast = given != nullptr && given->kind == YamlNode::Kind::kText && given->text == kFast;
  if (own == parameters.end()) {
    section.require(about.name, "a speed in m/s, or fast");
    if (!path.fast) path.speed = section.number(about.name, path.speed, kPathSpeeds);
    return;
  }
  if (!path.fast) path.speed = section.number(about.name, own->second, kPathSpeeds);
  if (path.fast || path.speed != own->second) {
    section.note(about.name, fmt::format("{:g}, the speed of the model", own->second));
  }
}

void read_acceleration(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const std::optional<Eigen::VectorXd> given = section.vector(about.name, 2);
  if (!given) return;
  if (!(given->minCoeff() > 0.0 && given->maxCoeff() <= kPathSpeeds.most)) {
    return section.note(about.name, "two numbers above 0 and up to 1000");
  }
  controller::SpeedLimits& limits = reading.scenario.target.path.limits;
  limits.along = (*given)[0];
  limits.across = (*given)[1];
}

/// Notes settings that are incompatible with a path, if there is one.
void check_path(const ScenarioReading& reading, Section& section) {
  const Scenario& scenario = reading.scenario;
  if (!has_path(scenario)) return;
  const Scenario::Controller& controller = scenario.controller;
  const auto refuse = [&](const std::string& what) {
    section.note(kPathKey, "a controller that follows paths", what);
  };
  if (is_outside(controller) || controller.kind == kObjectController) {
    refuse("a path with the controller " + controller.kind);
  } else if (driving_kind(controller) == "lqr" && controller.lqr_about == "target") {
    refuse("a path with lqr about the target");
  } else if (controller.guide != "none") {
    refuse("a path with the guide " + controller.guide);
  } else if (controller.penalty.shape == "thesis" && scenario.target.path.has_widths()) {
    refuse("a road with controller.penalty.shape thesis, which supports only boxes");
  }
  if (!scenario.target.angles.empty()) {
    section.note("angles", "none, because the headings along a path have no jumps");
  }
}

template <class Value>
std::optional<std::string> if_followed(const Scenario& scenario, Value&& value) {
  if (!has_path(scenario)) return std::nullopt;
  return std::forward<Value>(value)(scenario.target.path);
}

ListValue path_rows_value() {
  return list_of_values(VectorValue{.size = Dimension::kAny}, {.most = kMostPathRows});
}

ScenarioKey speed_key() {
  return {.about = {.name = kSpeedKey,
                    .values = {NumberValue{kPathSpeeds}, TextValue{.pattern = "^fast$"}},
                    .words = "speed at which a path is followed, {range}; or `fast`: as fast as "
                             "`acceleration` and `top_speed` allow",
                    .unit = "m/s",
                    .fallback_words = "the model's, where it has one; else required with a path"},
          .read = read_speed,
          .write = [](const Scenario& scenario, const models::SystemDescription& /*system*/) {
            return if_followed(scenario, [](const TargetPath& path) {
              return path.fast ? std::string(kFast) : yaml_number(path.speed);
            });
          }};
}

ScenarioKey acceleration_key() {
  return {
      .about = {.name = kAccelerationKey,
                .values = {VectorValue{.size = Dimension::kAny, .length = 2, .range = kPathSpeeds}},
                .words = "for a `fast` path: limits `[along, across]`, along it and towards the "
                         "inside of bends",
                .unit = "m/s²",
                .fallback_words = "`[2, 2]`"},
      .read = read_acceleration,
      .write = [](const Scenario& scenario, const models::SystemDescription& /*system*/) {
        return if_followed(scenario, [](const TargetPath& path) {
          return yaml_list(Eigen::Vector2d(path.limits.along, path.limits.across));
        });
      }};
}

}  // namespace

std::vector<ScenarioKey> path_keys() {
  return {
      {.about = {.name = kLapsKey,
                 .values = {WholeValue{1, 1000}},
                 .words = "number of laps of a closed path, {range}"},
       .member = [](Scenario& scenario) -> int& { return scenario.target.path.laps; },
       .is_written = has_path},
      speed_key(),
      acceleration_key(),
      {.about = {.name = kTopSpeedKey,
                 .values = {NumberValue{kPositive}},
                 .words = "for a `fast` path: speed limit, {range}",
                 .unit = "m/s",
                 .fallback_words = "any"},
       .member = [](Scenario& scenario) -> double& { return scenario.target.path.limits.top; },
       .is_written =
           [](const Scenario& scenario) {
             return has_path(scenario) && std::isfinite(scenario.target.path.limits.top);
           }},
      {.about = {.name = kClosedKey,
                 .values = {FlagValue{}},
                 .words = "whether the path continues from its last point to its first",
                 .fallback_words = "whether these are as close as its neighbouring points"},
       .read = read_with_path,
       .write =
           [](const Scenario& scenario, const models::SystemDescription& /*system*/) {
             return if_followed(scenario, [](const TargetPath& path) {
               return std::string(path.closed ? "true" : "false");
             });
           }},
      {.about =
           {.name = kPathKey,
            .values = {TextValue{.what = "a path"}, path_rows_value()},
            .words = fmt::format(
                "instead of `state`, a path to follow: a list of up to {} points `[x, y]` or `[x, "
                "y, right width, left width]`, or the path of a text file of points, absolute or "
                "relative to the scenario's folder. With widths, everything off the road is unsafe",
                kMostPathRows),
            .see = "[below](#paths)",
            .unit = "m",
            .fallback_words = "none"},
       .read = read_path,
       .check = check_path,
       .write = [](const Scenario& scenario, const models::SystemDescription& /*system*/) {
         return if_followed(scenario, [](const TargetPath& path) { return yaml_rows(path.rows); });
       }}};
}

}  // namespace qsmpc::harness
