// The program's side of controller_protocol.hpp.
#include <cmath>

#include <nlohmann/json.hpp>

#include "harness/control/controller_protocol.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/text/json_text.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json list_of(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  Json list = Json::array();
  for (const double value : vector) list.push_back(finite_or_null(value));
  return list;
}

Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(list_of(matrix.row(i).transpose()));
  return rows;
}

Json index_or_null(int index) { return index >= 0 ? Json(index) : Json(nullptr); }

Json coordinate_json(const models::Coordinate& one) {
  return {{"name", one.name}, {"unit", one.unit}, {"angle", one.is_angle}};
}

Json system_json(const Scenario& scenario, const models::SystemDescription& system) {
  Json states = Json::array();
  for (const models::Coordinate& state : system.states) states.push_back(coordinate_json(state));
  Json inputs = Json::array();
  for (std::size_t i = 0; i < system.inputs.size(); ++i) {
    Json input = coordinate_json(system.inputs[i]);
    input["lower"] = scenario.controller.input_lower[static_cast<Eigen::Index>(i)];
    input["upper"] = scenario.controller.input_upper[static_cast<Eigen::Index>(i)];
    inputs.push_back(std::move(input));
  }
  Json parameters = Json::object();
  for (const auto& [name, value] : scenario.model.parameters) parameters[name] = value;
  return {{"name", scenario.model.system},
          {"parameters", std::move(parameters)},
          {"states", std::move(states)},
          {"inputs", std::move(inputs)},
          {"position_x", index_or_null(system.position_x)},
          {"position_y", index_or_null(system.position_y)},
          {"heading", index_or_null(system.heading)}};
}

Json box_json(const controller::Box& box) {
  return {{"lower", list_of(box.lower)}, {"upper", list_of(box.upper)}};
}

/// A shape under its name, with the same keys as in a scenario.
struct ShapeJson {
  Json operator()(const controller::DiscShape& disc) const {
    return {{"disc", {{"centre", list_of(disc.centre)}, {"radius", disc.radius}}}};
  }
  Json operator()(const controller::EllipseShape& ellipse) const {
    return {{"ellipse",
             {{"centre", list_of(ellipse.centre)},
              {"semi_axes", list_of(ellipse.semi_axes)},
              {"angle", ellipse.angle}}}};
  }
  Json operator()(const controller::TurnedBoxShape& box) const {
    return {{"box",
             {{"centre", list_of(box.centre)}, {"size", list_of(box.size)}, {"angle", box.angle}}}};
  }
  Json operator()(const controller::PolygonShape& polygon) const {
    return {{"polygon", rows_of(polygon.corners.transpose())}};
  }
  Json operator()(const controller::HalfPlaneShape& half_plane) const {
    return {
        {"half_plane", {{"normal", list_of(half_plane.normal)}, {"offset", half_plane.offset}}}};
  }
};

Json safe_set_json(const controller::SafeSet& safe_set) {
  Json json = box_json(safe_set.bounds);
  json["obstacles"] = Json::array();
  for (const controller::Obstacle& obstacle : safe_set.obstacles) {
    const controller::Box* box = obstacle.box();
    Json one = box != nullptr ? box_json(*box) : std::visit(ShapeJson{}, *obstacle.shape());
    if (obstacle.motion) one["moves"] = true;
    json["obstacles"].push_back(std::move(one));
  }
  return json;
}

/// Indexed by moving obstacle, stage and way.
Json forecast_json(const controller::ObstacleForecast& forecast) {
  Json obstacles = Json::array();
  for (std::size_t n = 0; n < forecast.size(); ++n) {
    Json stages = Json::array();
    for (const std::vector<controller::ObstaclePlace>& places : forecast.of(n)) {
      Json ways = Json::array();
      for (const controller::ObstaclePlace& place : places) {
        ways.push_back({{"weight", place.weight},
                        {"offset", list_of(place.offset)},
                        {"turn", place.turn},
                        {"covariance", rows_of(place.covariance)}});
      }
      stages.push_back(std::move(ways));
    }
    obstacles.push_back(std::move(stages));
  }
  return obstacles;
}

Json footprint_json(const controller::Body& body) {
  Json discs = Json::array();
  for (const controller::Disc& disc : body.discs) {
    discs.push_back({{"radius", disc.radius}, {"offset", {disc.offset.x(), disc.offset.y()}}});
  }
  return discs;
}

}  // namespace

std::string scenario_message(const Scenario& scenario, const models::SystemDescription& system) {
  const Scenario::Controller& controller = scenario.controller;
  Json json{{"type", kScenarioMessage},
            {"protocol", kProtocolVersion},
            {"program", std::string("qsmpc ") + kVersion},
            {"name", scenario.name},
            {"seed", scenario.seed},
            {"time_step", scenario.time_step},
            {"step_limit", scenario.step_limit}};
  json["system"] = system_json(scenario, system);
  json["initial_state"] = {{"mean", list_of(scenario.initial_state.mean)},
                           {"covariance", rows_of(scenario.initial_state.covariance)}};
  json["disturbance"] = {{"covariance", rows_of(scenario.disturbance.covariance)},
                         {"sensor", rows_of(scenario.disturbance.sensor)}};
  json["safe_set"] = safe_set_json(scenario.safe_set);
  json["footprint"] = footprint_json(scenario.safe_set.body);
  json["target"] = {{"state", list_of(scenario.target.state)},
                    {"radius", scenario.target.radius},
                    {"angles", scenario.target.angles}};
  if (const auto& route = scenario.target.route) {
    json["target"]["waypoints"] = rows_of(route->states.transpose());
    json["target"]["waypoint_radius"] = route->radius;
  }
  json["risk"] = {{"stage", finite_or_null(scenario.risk.stage)},
                  {"plan", finite_or_null(scenario.risk.plan)},
                  {"mission", finite_or_null(scenario.risk.mission)},
                  {"otherwise", scenario.risk.otherwise}};
  json["cost"] = {{"state", rows_of(controller.cost.state)},
                  {"input", rows_of(controller.cost.input)},
                  {"terminal", rows_of(controller.cost.terminal)}};
  json["horizon"] = controller.horizon;
  json["plans"] = controller.outside.plans;
  json["deadline"] = answer_deadline(controller);
  json["options"] = Json::parse(controller.outside.options);
  return compact_json_text(json);
}

std::string reset_message(std::uint64_t seed) {
  return compact_json_text({{"type", kResetMessage}, {"seed", seed}});
}

std::string situation_message(const controller::Situation& situation, double deadline) {
  const Json belief{{"mean", list_of(situation.belief.mean)},
                    {"covariance", rows_of(situation.belief.covariance)}};
  Json json{{"type", kSituationMessage}, {"period", situation.period},
            {"time", situation.time},    {"observation", list_of(situation.observation)},
            {"belief", belief},          {"periods_left", situation.periods_left},
            {"deadline", deadline}};
  if (situation.progress) {
    json["waypoints_passed"] = static_cast<int>(*situation.progress);
  }
  if (situation.obstacles != nullptr) json["obstacles"] = forecast_json(*situation.obstacles);
  return compact_json_text(json);
}

std::string end_message() { return compact_json_text({{"type", kEndMessage}}); }

}  // namespace qsmpc::harness
