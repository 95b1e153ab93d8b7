// The true poses of an episode's moving obstacles at any time.
//
//   const DrivenObstacles others(trace);
//   const Eigen::Matrix3Xd poses = others.poses_at(1.25);
//   for (std::size_t n = 0; n < others.count(); ++n) draw(others.shape_at(n, poses));
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/planar_shape.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// A pose is an obstacle's offset x, y (m) from its position in the scenario and its rotation
/// (rad); poses are 3 x count.
class DrivenObstacles {
 public:
  /// Copies what it needs from `trace`. Without recorded poses, obstacles stand where the scenario
  /// places them.
  explicit DrivenObstacles(const Trace& trace);

  [[nodiscard]] bool empty() const { return shapes_.empty(); }
  [[nodiscard]] std::size_t count() const { return shapes_.size(); }

  /// The poses at each control instant, including the end where it is known; at least one entry.
  [[nodiscard]] const std::vector<Eigen::Matrix3Xd>& poses() const { return poses_; }

  /// The poses at `time` (s), which is clamped to these instants: linear interpolation, rotating
  /// the shorter way.
  [[nodiscard]] Eigen::Matrix3Xd poses_at(double time) const;

  /// Obstacle n as the scenario has it, and at its pose among `poses`.
  [[nodiscard]] const controller::PlanarShape& shape(std::size_t n) const { return shapes_[n]; }
  [[nodiscard]] controller::PlanarShape shape_at(std::size_t n,
                                                 const Eigen::Matrix3Xd& poses) const;

 private:
  double time_step_;
  std::vector<controller::PlanarShape> shapes_;
  std::vector<Eigen::Matrix3Xd> poses_;
};

}  // namespace qsmpc::harness
