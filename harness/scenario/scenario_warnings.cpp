#include "harness/scenario/scenario_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "controller/certification/initial_risk.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/error_origin.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

bool can_be_unsafe(const controller::SafeSet& safe_set) {
  return !safe_set.obstacles.empty() || safe_set.road != nullptr ||
         !controller::bounded_axes(safe_set.bounds).empty();
}

void warn_of_limits(const Scenario& scenario, std::vector<std::string>& warnings) {
  const Scenario::Risk& risk = scenario.risk;
  if (!risk.any() || !can_be_unsafe(scenario.safe_set)) return;
  const std::array<std::pair<const char*, double>, 3> limits = {
      {{"stage", risk.stage}, {"plan", risk.plan}, {"mission", risk.mission}}};
  double least = kInfinity;
  for (const auto& [name, limit] : limits) {
    if (limit > 0.0) {
      least = std::min(least, limit);
    } else {
      warnings.push_back(fmt::format(
          "risk.{} is 0, but no certificate is ever 0: the limit is exceeded in every period",
          name));
    }
  }
  const double start = controller::initial_risk(
      {.mean = scenario.initial_state.mean, .covariance = scenario.initial_state.covariance},
      scenario.safe_set);
  if (start > least) {
    warnings.push_back(
        fmt::format("the start is unsafe with a certified probability of up to {:.3g}, above the "
                    "limit of {:.3g}",
                    start, least));
  }
}

/// A heading of a full turn or more is unlikely to be in radians.
void warn_of_degrees(const Scenario& scenario, std::vector<std::string>& warnings) {
  const std::vector<models::Coordinate> states = system_of(scenario).states;
  const auto question = [&](const std::string& key, const Eigen::VectorXd& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const models::Coordinate& state = states[static_cast<std::size_t>(i)];
      if (state.unit != "rad" || !(std::abs(values[i]) > kTurn)) continue;
      warnings.push_back(
          fmt::format("{}: {} = {:.4g} is more than a full turn: angles are in radians; {:.4g} "
                      "degrees are {:.4g}",
                      key, state.name, values[i], values[i], values[i] * std::numbers::pi / 180.0));
    }
  };
  question("initial_state.mean", scenario.initial_state.mean);
  if (scenario.target.has_waypoints()) {
    for (std::size_t i = 0; i < scenario.target.waypoints.size(); ++i) {
      const Eigen::VectorXd& given = scenario.target.waypoints[i];
      if (given.size() == std::ssize(states)) {
        question(fmt::format("target.waypoints.{}", i), given);
      }
    }
  } else {
    question("target.state", scenario.target.state);
  }
}

/// For a model error whose file states the plant that it was measured on.
void warn_of_error_plant(const Scenario& scenario, std::vector<std::string>& warnings) {
  for (const std::string& difference : plant_differences(scenario)) {
    warnings.push_back(
        "model_error was measured on another plant and need not hold for this one: " + difference);
  }
}

}  // namespace

std::vector<std::string> scenario_warnings(const Scenario& scenario) {
  std::vector<std::string> warnings;
  if (const std::string why = why_no_bound(scenario); !why.empty()) {
    warnings.push_back("no certificate is a bound: " + why);
  }
  warn_of_degrees(scenario, warnings);
  warn_of_error_plant(scenario, warnings);
  warn_of_limits(scenario, warnings);
  return warnings;
}

}  // namespace qsmpc::harness
