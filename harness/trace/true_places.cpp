#include "harness/trace/true_places.hpp"

#include <utility>

#include "harness/trace/driven_obstacles.hpp"

namespace qsmpc::harness {

std::shared_ptr<controller::ObstacleForecast> known_places(
    const std::vector<Eigen::Matrix3Xd>& poses) {
  const auto count = static_cast<std::size_t>(poses.front().cols());
  auto known = std::make_shared<controller::ObstacleForecast>(count);
  for (std::size_t n = 0; n < count; ++n) {
    controller::PlacesByStage places;
    for (const Eigen::Matrix3Xd& at : poses) {
      const auto column = at.col(static_cast<Eigen::Index>(n));
      places.push_back({{.offset = column.head<2>(), .turn = column[2]}});
    }
    known->set(n, std::move(places));
  }
  return known;
}

controller::SafeSet driven_safe_set(const Trace& trace) {
  controller::SafeSet safe_set = trace.scenario.safe_set;
  const DrivenObstacles others(trace);
  if (!others.empty()) safe_set.forecast = known_places(others.poses());
  return safe_set;
}

}  // namespace qsmpc::harness
