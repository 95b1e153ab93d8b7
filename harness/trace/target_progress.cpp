#include "harness/trace/target_progress.hpp"

#include <utility>

#include "controller/reference/progress.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {

void TargetProgress::advance(const Eigen::VectorXd& state) {
  if (!state.allFinite()) return;
  now_ = controller::progress_after(scenario_.target.course, scenario_.target.route, system_, state,
                                    now_);
}

std::vector<double> progress_of(const Trace& trace) {
  std::vector<double> along;
  const Scenario::Target& target = trace.scenario.target;
  if (!target.course && !target.route) return along;
  TargetProgress progress(trace.scenario, trace.system);
  const Eigen::MatrixXd states = true_states(trace);
  for (Eigen::Index k = 0; k < states.cols(); ++k) {
    progress.advance(states.col(k));
    along.push_back(progress.now().value_or(target.course ? target.course->begin : 0.0));
  }
  return along;
}

std::optional<WaypointTimes> waypoint_times(const Trace& trace) {
  const Scenario::Target& target = trace.scenario.target;
  if (!target.route) return std::nullopt;
  WaypointTimes passed{.wanted = target.route->count()};
  const std::vector<double> counts = progress_of(trace);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double now = static_cast<double>(k) * trace.scenario.time_step;
    passed.times.resize(static_cast<std::size_t>(counts[k]), now);
  }
  if (ended_at_target(trace)) {
    passed.times.push_back(static_cast<double>(trace.steps.size()) * trace.scenario.time_step);
  }
  return passed;
}

std::optional<Laps> laps_of(const Trace& trace) {
  const Scenario::Target& target = trace.scenario.target;
  if (!target.course || !target.path.closed) return std::nullopt;
  Laps laps{.wanted = target.path.laps};
  const std::vector<double> along = progress_of(trace);
  double begin = 0.0;
  double line = target.course->begin + target.course->path->length();
  for (std::size_t k = 1; k < along.size(); ++k) {
    if (along[k] < line) continue;
    const double share = (line - along[k - 1]) / (along[k] - along[k - 1]);
    const double now = (static_cast<double>(k - 1) + share) * trace.scenario.time_step;
    laps.times.push_back(now - begin);
    begin = now;
    line += target.course->path->length();
  }
  return laps;
}

}  // namespace qsmpc::harness
