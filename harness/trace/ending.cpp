#include "harness/trace/ending.hpp"

#include <algorithm>
#include <cmath>

#include "controller/planning/cost/angular_target.hpp"
#include "harness/trace/target_progress.hpp"
#include "harness/trace/true_places.hpp"

namespace qsmpc::harness {

bool at_target(const Scenario& scenario, const models::SystemDescription& system,
               const Eigen::VectorXd& state, std::optional<double> progress) {
  if (scenario.target.course) {
    const controller::PathTarget& course = *scenario.target.course;
    if (!progress) return false;
    if (course.path->closed()) return *progress >= course.end;
    if (*progress < course.end - scenario.target.radius) return false;
  }
  if (const auto& route = scenario.target.route) {
    if (!progress || *progress + 1.0 < route->count()) return false;
  }
  const Eigen::VectorXd offset =
      controller::target_offset(scenario.target.state, scenario.target.angles, state);
  const int x = system.position_x;
  const int y = system.position_y;
  const double distance = x >= 0 && y >= 0 ? std::hypot(offset[x], offset[y]) : offset.norm();
  return distance <= scenario.target.radius;
}

namespace {

std::optional<double> final_progress(const Trace& trace) {
  const std::vector<double> along = progress_of(trace);
  if (along.empty()) return std::nullopt;
  return along.back();
}

}  // namespace

bool ended_at_target(const Trace& trace) {
  switch (trace.outcome) {
    case Outcome::kReached:
      return true;
    case Outcome::kCollision:
    case Outcome::kLeftBounds:
      // A drive that stops when unsafe ends before arrival is checked.
      if (trace.scenario.stop_when_unsafe || trace.final_state.size() == 0) return false;
      return at_target(trace.scenario, trace.system, trace.final_state, final_progress(trace));
    case Outcome::kTimeout:
    case Outcome::kFault:
    case Outcome::kInterrupted:
      break;
  }
  return false;
}

std::optional<Outcome> outcome_in(controller::UnsafePart part) {
  switch (part) {
    case controller::UnsafePart::kObstacle:
      return Outcome::kCollision;
    case controller::UnsafePart::kBounds:
      return Outcome::kLeftBounds;
    case controller::UnsafePart::kNone:
      break;
  }
  return std::nullopt;
}

std::optional<Outcome> first_unsafe_outcome(const Trace& trace) {
  const controller::UnsafeSet unsafe(driven_safe_set(trace));
  const Eigen::MatrixXd states = true_states(trace);
  for (Eigen::Index k = 0; k < states.cols(); ++k) {
    const auto outcome = outcome_in(controller::unsafe_part(states.col(k), unsafe, k));
    if (outcome) return outcome;
  }
  return std::nullopt;
}

std::vector<std::pair<std::string, std::int64_t>> in_order(
    const std::map<std::string, std::int64_t>& outcomes) {
  std::vector<std::pair<std::string, std::int64_t>> ordered(outcomes.begin(), outcomes.end());
  std::ranges::stable_sort(ordered, {}, [](const auto& entry) {
    return std::ranges::find(outcome_names(), entry.first) - outcome_names().begin();
  });
  return ordered;
}

}  // namespace qsmpc::harness
