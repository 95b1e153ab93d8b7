// The keys of a target that is a list of waypoints.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/standing.hpp"
#include "harness/scenario/keys/listed_rows.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/scenario/value_checks.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kWaypointsKey = "waypoints";
constexpr const char* kRadiusKey = "waypoint_radius";
constexpr std::size_t kMostWaypoints = 1000;

bool has_waypoints(const Scenario& scenario) { return scenario.target.has_waypoints(); }

/// The target state at each of `rows`: the state as written or, for a position alone, that
/// position, the heading of the straight line to it, and 0 for the other states.
Eigen::MatrixXd wanted_states(const std::vector<Eigen::VectorXd>& rows,
                              const models::SystemDescription& system,
                              const Eigen::VectorXd& start) {
  constexpr double kFullTurn = 2.0 * std::numbers::pi;
  Eigen::MatrixXd states = Eigen::MatrixXd::Zero(start.size(), std::ssize(rows));
  Eigen::Vector2d from(start[system.position_x], start[system.position_y]);
  double before = system.heading >= 0 ? start[system.heading] : 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto state = states.col(static_cast<Eigen::Index>(i));
    if (rows[i].size() == start.size() && start.size() != 2) {
      state = rows[i];
    } else {
      state[system.position_x] = rows[i][0];
      state[system.position_y] = rows[i][1];
    }
    const Eigen::Vector2d to(state[system.position_x], state[system.position_y]);
    if (system.heading >= 0 && rows[i].size() == 2) {
      const Eigen::Vector2d way = to - from;
      const double along = way.isZero(0.0) ? before : std::atan2(way.y(), way.x());
      state[system.heading] = along + kFullTurn * std::round((before - along) / kFullTurn);
    }
    if (system.heading >= 0) before = state[system.heading];
    from = to;
  }
  return states;
}

/// Notes a waypoint that repeats the previous position.
void check_places(const Eigen::MatrixXd& states, const models::SystemDescription& system,
                  Section& section) {
  for (Eigen::Index i = 1; i < states.cols(); ++i) {
    const Eigen::VectorXd step = states.col(i) - states.col(i - 1);
    if (step[system.position_x] != 0.0 || step[system.position_y] != 0.0) continue;
    section.note_item(kWaypointsKey, static_cast<std::size_t>(i),
                      "a place other than that of the previous waypoint",
                      fmt::format("({:g}, {:g}) again", states(system.position_x, i),
                                  states(system.position_y, i)));
  }
}

void read_waypoints(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  if (!section.has(about.name)) {
    (void)section.tree(about.name);
    if (section.has(kRadiusKey)) {
      section.note(kRadiusKey, "target.waypoints that it applies to");
    }
    return;
  }
  const models::SystemDescription& system = reading.system();
  if (system.position_x < 0 || system.position_y < 0) {
    (void)section.tree(about.name);
    return section.note(about.name, "none, because the system has no position in the plane");
  }
  if (section.has("path")) {
    (void)section.tree(about.name);
    return section.note(about.name, "none beside a path: only one of them can say where to go");
  }
  const auto n = static_cast<std::size_t>(std::ssize(system.states));
  auto rows = read_rows(section, about.name,
                        {.widths = {2, n},
                         .words = n == 2 ? "[x, y]" : fmt::format("[x, y], or {} numbers", n),
                         .name = "waypoints",
                         .most = kMostWaypoints,
                         .alike = false});
  if (!rows) return;
  Scenario& scenario = reading.scenario;
  Scenario::Target& target = scenario.target;
  target.waypoints = std::move(*rows);
  target.route = {.states = wanted_states(target.waypoints, system, scenario.initial_state.mean),
                  .radius = section.number(kRadiusKey, target.radius, kPositive)};
  check_places(target.route->states, system, section);
  target.state = target.route->states.rightCols<1>();
}

/// Notes waypoints that are not safe, and settings that cannot drive to waypoints in turn.
void check_waypoints(const ScenarioReading& reading, Section& section) {
  const Scenario& scenario = reading.scenario;
  if (!has_waypoints(scenario)) return;
  const controller::SafeSet standing = controller::standing(scenario.safe_set);
  const Eigen::MatrixXd& states = scenario.target.route->states;
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const auto item = static_cast<std::size_t>(i);
    if (states.col(i).cwiseAbs().maxCoeff() > kLargestCoordinate) {
      section.note_item(kWaypointsKey, item,
                        fmt::format("numbers of at most {:g} in size", kLargestCoordinate));
    } else if (const auto problem = why_unsafe(states.col(i), standing, reading.system().states)) {
      section.note_item(kWaypointsKey, item, "a state in the safe set", *problem);
    }
  }
  const Scenario::Controller& controller = scenario.controller;
  const auto refuse = [&](const std::string& what) {
    section.note(kWaypointsKey, "a controller that drives to waypoints in turn", what);
  };
  if (driving_kind(controller) == "lqr" && controller.lqr_about == "target") {
    refuse("waypoints with lqr about the target");
  } else if (controller.guide != "none") {
    refuse("waypoints with the guide " + controller.guide);
  }
}

std::optional<std::string> waypoints_text(const Scenario& scenario,
                                          const models::SystemDescription& /*system*/) {
  if (!has_waypoints(scenario)) return std::nullopt;
  std::vector<std::string> rows;
  for (const Eigen::VectorXd& row : scenario.target.waypoints) rows.push_back(yaml_list(row));
  return fmt::format("[{}]", fmt::join(rows, ", "));
}

}  // namespace

std::vector<ScenarioKey> waypoint_keys() {
  return {{.about = {.name = kRadiusKey,
                     .values = {NumberValue{kPositive}},
                     .words = "distance in the plane at which each waypoint except the last counts "
                              "as passed, {range}",
                     .unit = "m",
                     .fallback_words = "`target.radius`"},
           // Does nothing: `waypoints` reads this key.
           .read = [](ScenarioReading& /*reading*/, Section& section,
                      const KeyDescription& about) { (void)section.tree(about.name); },
           .write = [](const Scenario& scenario,
                       const models::SystemDescription& /*system*/) -> std::optional<std::string> {
             if (!has_waypoints(scenario)) return std::nullopt;
             return yaml_number(scenario.target.route->radius);
           }},
          {.about = {.name = kWaypointsKey,
                     .values = {list_of_values(VectorValue{.size = Dimension::kAny},
                                               {.least = 1, .most = kMostWaypoints})},
                     .words = fmt::format(
                         "instead of `state`, a list of up to {} places to drive to in turn, `[x, "
                         "y]` or *n* numbers each; the drive ends at the last",
                         kMostWaypoints),
                     .see = "[below](#waypoints)",
                     .unit = "m",
                     .fallback_words = "none"},
           .read = read_waypoints,
           .check = check_waypoints,
           .write = waypoints_text}};
}

}  // namespace qsmpc::harness
