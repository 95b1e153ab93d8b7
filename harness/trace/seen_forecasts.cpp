#include "harness/trace/seen_forecasts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "controller/regions/safe_set.hpp"
#include "controller/surroundings/motion_filter.hpp"

namespace qsmpc::harness {
namespace {

// Number of periods, from the first on, that have a measurement of every obstacle.
std::size_t seen_periods(const Trace& trace, Eigen::Index obstacles) {
  const auto unseen =
      std::find_if(trace.steps.begin(), trace.steps.end(), [&](const StepRecord& step) {
        return step.obstacles_seen.cols() != obstacles || !step.obstacles_seen.allFinite();
      });
  return static_cast<std::size_t>(unseen - trace.steps.begin());
}

controller::PlacesByStage picked(const controller::PlacesByStage& all,
                                 const std::vector<int>& stages) {
  controller::PlacesByStage some;
  some.reserve(stages.size());
  for (const int stage : stages) some.push_back(all[static_cast<std::size_t>(stage)]);
  return some;
}

}  // namespace

std::vector<int> spread_stages(int horizon, int most) {
  const int count = std::min(horizon + 1, most);
  std::vector<int> stages;
  for (int i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / (count - 1) : 0.0;
    stages.push_back(static_cast<int>(std::lround(share * horizon)));
  }
  return stages;
}

std::vector<KnownForecasts> seen_forecasts(const Trace& trace, const std::vector<int>& stages) {
  std::vector<KnownForecasts> known(trace.steps.size());
  const auto moving = controller::moving_obstacles(trace.scenario.safe_set);
  if (moving.empty() || stages.empty()) return known;
  const std::size_t periods = seen_periods(trace, static_cast<Eigen::Index>(moving.size()));
  for (std::size_t n = 0; n < moving.size(); ++n) {
    controller::MotionFilter filter(*moving[n]->motion, trace.scenario.time_step);
    for (std::size_t k = 0; k < periods; ++k) {
      if (k > 0) filter.advance();
      filter.see(trace.steps[k].obstacles_seen.col(static_cast<Eigen::Index>(n)));
      known[k].push_back(picked(filter.forecast(stages.back()), stages));
    }
  }
  return known;
}

}  // namespace qsmpc::harness
