#include "harness/scenario/scenario_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "controller/certification/initial_risk.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

bool can_be_unsafe(const controller::SafeSet& safe_set) {
  return !safe_set.obstacles.empty() || !controller::bounded_axes(safe_set.bounds).empty();
}

}  // namespace

std::vector<std::string> scenario_warnings(const Scenario& scenario) {
  const Scenario::Risk& risk = scenario.risk;
  std::vector<std::string> warnings;
  if (!risk.any() || !can_be_unsafe(scenario.safe_set)) return warnings;
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
    warnings.push_back(fmt::format(
        "the start is unsafe with a certified probability up to {:.3g}, above the limit of {:.3g}",
        start, least));
  }
  return warnings;
}

}  // namespace qsmpc::harness
