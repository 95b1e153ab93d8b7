#include "harness/trace/driven_obstacles.hpp"

#include <algorithm>
#include <iterator>

#include "controller/regions/safe_set.hpp"
#include "models/motion/obstacle_poses.hpp"

namespace qsmpc::harness {

DrivenObstacles::DrivenObstacles(const Trace& trace) : time_step_(trace.scenario.time_step) {
  for (const controller::Obstacle* one : controller::moving_obstacles(trace.scenario.safe_set)) {
    shapes_.push_back(*one->shape());
  }
  const auto add = [this](const Eigen::Matrix3Xd& poses) {
    const bool known = poses.cols() == std::ssize(shapes_) && poses.allFinite();
    if (known) poses_.push_back(poses);
    return known;
  };
  const bool all = std::all_of(trace.steps.begin(), trace.steps.end(),
                               [&](const StepRecord& step) { return add(step.obstacles); });
  if (all) add(trace.final_obstacles);
  if (poses_.empty()) poses_.emplace_back(Eigen::Matrix3Xd::Zero(3, std::ssize(shapes_)));
}

Eigen::Matrix3Xd DrivenObstacles::poses_at(double time) const {
  const double period = std::max(0.0, time / time_step_);
  const auto last = static_cast<double>(poses_.size() - 1);
  if (!(period < last)) return poses_.back();
  const auto k = static_cast<std::size_t>(period);
  return models::poses_between(poses_[k], poses_[k + 1], period - static_cast<double>(k));
}

controller::PlanarShape DrivenObstacles::shape_at(std::size_t n,
                                                  const Eigen::Matrix3Xd& poses) const {
  const auto column = static_cast<Eigen::Index>(n);
  return controller::moved(shapes_[n], poses.col(column).head<2>(), poses(2, column));
}

}  // namespace qsmpc::harness
