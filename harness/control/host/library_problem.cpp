#include "harness/control/host/library_problem.hpp"

#include <limits>
#include <utility>

namespace qsmpc::harness {
namespace {

using nlohmann::json;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

void append(const json& value, double infinity, std::vector<double>& numbers) {
  if (value.is_array()) {
    for (const json& item : value) append(item, infinity, numbers);
  } else {
    numbers.push_back(value.is_null() ? infinity : value.get<double>());
  }
}

double limit_in(const json& value) { return value.is_null() ? kNoLimit : value.get<double>(); }

int index_in(const json& value) { return value.is_null() ? -1 : value.get<int>(); }

/// The values of `key` in all items, concatenated.
std::vector<double> column(const json& list, const char* key, double infinity) {
  std::vector<double> numbers;
  for (const json& item : list) append(item.at(key), infinity, numbers);
  return numbers;
}

}  // namespace

std::vector<double> numbers_in(const json& list, double infinity) {
  std::vector<double> numbers;
  append(list, infinity, numbers);
  return numbers;
}

LibraryProblem::LibraryProblem(const json& scenario, std::string line) {
  problem_.name = keep(scenario.at("name").get<std::string>());
  problem_.time_step = scenario.at("time_step").get<double>();
  problem_.step_limit = scenario.at("step_limit").get<int>();
  problem_.horizon = scenario.at("horizon").get<int>();
  problem_.plans = scenario.at("plans").get<bool>() ? 1 : 0;
  problem_.deadline = scenario.at("deadline").get<double>();
  add_system(scenario);
  add_surroundings(scenario);
  problem_.options = keep(scenario.at("options").dump());
  problem_.json = keep(std::move(line));
}

const char* LibraryProblem::keep(std::string text) {
  return texts_.emplace_back(std::move(text)).c_str();
}

const double* LibraryProblem::keep(std::vector<double> numbers) {
  return numbers_.emplace_back(std::move(numbers)).data();
}

void LibraryProblem::add_system(const json& scenario) {
  const json& system = scenario.at("system");
  problem_.system = keep(system.at("name").get<std::string>());
  const auto coordinates = [this](const json& list, std::vector<qsmpc_coordinate>& kept) {
    for (const json& one : list) {
      kept.push_back({keep(one.at("name").get<std::string>()),
                      keep(one.at("unit").get<std::string>()),
                      one.at("angle").get<bool>() ? 1 : 0});
    }
  };
  coordinates(system.at("states"), states_);
  coordinates(system.at("inputs"), inputs_);
  problem_.state_dim = static_cast<std::int32_t>(states_.size());
  problem_.input_dim = static_cast<std::int32_t>(inputs_.size());
  problem_.states = states_.data();
  problem_.inputs = inputs_.data();
  problem_.position_x = index_in(system.at("position_x"));
  problem_.position_y = index_in(system.at("position_y"));
  problem_.heading = index_in(system.at("heading"));
  std::vector<double> values;
  for (const auto& [name, value] : system.at("parameters").items()) {
    parameter_names_.push_back(keep(std::string(name)));
    values.push_back(value.get<double>());
  }
  problem_.parameter_count = static_cast<std::int32_t>(values.size());
  problem_.parameter_names = parameter_names_.data();
  problem_.parameter_values = keep(std::move(values));
  problem_.input_lower = keep(column(system.at("inputs"), "lower", -kNoLimit));
  problem_.input_upper = keep(column(system.at("inputs"), "upper", kNoLimit));
}

void LibraryProblem::add_surroundings(const json& scenario) {
  const auto kept = [this](const json& list) { return keep(numbers_in(list, kNoLimit)); };
  problem_.initial_mean = kept(scenario.at("initial_state").at("mean"));
  problem_.initial_covariance = kept(scenario.at("initial_state").at("covariance"));
  problem_.noise_covariance = kept(scenario.at("disturbance").at("covariance"));
  problem_.sensor_covariance = kept(scenario.at("disturbance").at("sensor"));
  const json& safe_set = scenario.at("safe_set");
  problem_.bounds_lower = keep(numbers_in(safe_set.at("lower"), -kNoLimit));
  problem_.bounds_upper = keep(numbers_in(safe_set.at("upper"), kNoLimit));
  json obstacles = json::array();
  for (const json& obstacle : safe_set.at("obstacles")) {
    if (obstacle.contains("lower")) obstacles.push_back(obstacle);  // shapes are only in `json`
  }
  problem_.obstacle_count = static_cast<std::int32_t>(obstacles.size());
  problem_.obstacle_lower = keep(column(obstacles, "lower", -kNoLimit));
  problem_.obstacle_upper = keep(column(obstacles, "upper", kNoLimit));
  const json& discs = scenario.at("footprint");
  problem_.disc_count = static_cast<std::int32_t>(discs.size());
  problem_.disc_radii = keep(column(discs, "radius", kNoLimit));
  problem_.disc_offsets = keep(column(discs, "offset", kNoLimit));
  problem_.target = kept(scenario.at("target").at("state"));
  problem_.target_radius = scenario.at("target").at("radius").get<double>();
  const json& cost = scenario.at("cost");
  problem_.cost_state = kept(cost.at("state"));
  problem_.cost_input = kept(cost.at("input"));
  problem_.cost_terminal = kept(cost.at("terminal"));
  const json& risk = scenario.at("risk");
  problem_.risk_stage = limit_in(risk.at("stage"));
  problem_.risk_plan = limit_in(risk.at("plan"));
  problem_.risk_mission = limit_in(risk.at("mission"));
}

}  // namespace qsmpc::harness
