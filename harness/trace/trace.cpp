#include "harness/trace/trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

namespace qsmpc::harness {
namespace {

constexpr std::array<std::pair<Outcome, const char*>, 6> kOutcomeNames = {{
    {Outcome::kReached, "reached"},
    {Outcome::kCollision, "collision"},
    {Outcome::kLeftBounds, "left_bounds"},
    {Outcome::kTimeout, "timeout"},
    {Outcome::kFault, "fault"},
    {Outcome::kInterrupted, "interrupted"},
}};

}  // namespace

const char* outcome_name(Outcome outcome) {
  for (const auto& [value, name] : kOutcomeNames) {
    if (value == outcome) return name;
  }
  throw std::invalid_argument("not an outcome");
}

const std::vector<std::string>& outcome_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    all.reserve(kOutcomeNames.size());
    for (const auto& [value, name] : kOutcomeNames) all.emplace_back(name);
    return all;
  }();
  return names;
}

std::string outcome_list() {
  std::string list;
  for (const std::string& name : outcome_names()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

Outcome outcome_from_name(const std::string& name) {
  for (const auto& [value, known] : kOutcomeNames) {
    if (name == known) return value;
  }
  throw std::invalid_argument("\"" + name + "\" is not an outcome: " + outcome_list());
}

const char* fault_of_name(FaultOf fault_of) {
  return fault_of == FaultOf::kController ? "controller" : "plant";
}

Eigen::MatrixXd true_states(const Trace& trace) {
  const bool ended = trace.final_state.size() > 0;
  const auto steps = static_cast<Eigen::Index>(trace.steps.size());
  const Eigen::Index dim = ended       ? trace.final_state.size()
                           : steps > 0 ? trace.steps.front().state.size()
                                       : 0;
  Eigen::MatrixXd states(dim, steps + (ended ? 1 : 0));
  for (Eigen::Index k = 0; k < steps; ++k) {
    states.col(k) = trace.steps[static_cast<std::size_t>(k)].state;
  }
  if (ended) states.col(steps) = trace.final_state;
  return states;
}

Eigen::Index completed_periods(const Trace& trace) {
  const auto steps = static_cast<Eigen::Index>(trace.steps.size());
  // A controller that fails does so before its period begins.
  const bool plant_broke = trace.outcome == Outcome::kFault && trace.fault_of == FaultOf::kPlant;
  const bool end_is_known = trace.final_state.size() > 0 && !plant_broke;
  return end_is_known || steps == 0 ? steps : steps - 1;
}

std::string clearance_unit_of(const controller::SafeSet& safe_set,
                              const models::SystemDescription& system) {
  std::set<std::string> units;
  const auto add = [&](const controller::Box& box) {
    for (Eigen::Index i = 0; i < std::min(box.lower.size(), std::ssize(system.states)); ++i) {
      if (!std::isfinite(box.lower[i]) && !std::isfinite(box.upper[i])) continue;
      units.insert(system.states[static_cast<std::size_t>(i)].unit);
    }
  };
  add(safe_set.bounds);
  for (const controller::Obstacle& obstacle : safe_set.obstacles) {
    if (const controller::Box* box = obstacle.box()) {
      add(*box);
    } else {
      units.insert(system.states[static_cast<std::size_t>(system.position_x)].unit);
    }
  }
  return units.size() == 1 ? *units.begin() : "state units";
}

}  // namespace qsmpc::harness
