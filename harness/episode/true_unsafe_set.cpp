#include "harness/episode/true_unsafe_set.hpp"

#include <cmath>
#include <utility>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

controller::SafeSet with_forecast(controller::SafeSet safe_set,
                                  std::shared_ptr<controller::ObstacleForecast> forecast) {
  safe_set.forecast = std::move(forecast);
  return safe_set;
}

}  // namespace

std::shared_ptr<controller::ObstacleForecast> new_forecast(const controller::SafeSet& safe_set) {
  const std::size_t count = controller::moving_obstacles(safe_set).size();
  return count == 0 ? nullptr : std::make_shared<controller::ObstacleForecast>(count);
}

TrueUnsafeSet::TrueUnsafeSet(controller::SafeSet safe_set)
    : places_(new_forecast(safe_set)), unsafe_(with_forecast(std::move(safe_set), places_)) {}

void TrueUnsafeSet::place(const Eigen::Matrix3Xd& poses) {
  for (Eigen::Index n = 0; n < poses.cols(); ++n) {
    const controller::ObstaclePlace place{.offset = poses.col(n).head<2>(), .turn = poses(2, n)};
    places_->set(static_cast<std::size_t>(n), {{place}});
  }
}

double TrueUnsafeSet::least_clearance(const Eigen::MatrixXd& states,
                                      const MovingObstacles& others) {
  double least = kNotANumber;
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const auto share = static_cast<double>(i + 1) / static_cast<double>(states.cols());
    if (others.count() > 0) place(others.poses_at(share));
    least = std::fmin(least, clearance(states.col(i)));
  }
  return least;
}

}  // namespace qsmpc::harness
