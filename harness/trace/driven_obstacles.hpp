// The obstacles of an episode that move: where they truly were, at any time.
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

/// Poses are an offset x, y (m) from where each is written and a turn (rad), 3 x count.
class DrivenObstacles {
 public:
  /// Takes what it needs of `trace`. They stand where they are written as far as it has no poses.
  explicit DrivenObstacles(const Trace& trace);

  [[nodiscard]] bool empty() const { return shapes_.empty(); }
  [[nodiscard]] std::size_t count() const { return shapes_.size(); }

  /// At each control instant, the end included where it is known; at least one.
  [[nodiscard]] const std::vector<Eigen::Matrix3Xd>& poses() const { return poses_; }

  /// At `time` (s), which is clamped to these instants: linear between them, turned the shorter
  /// way.
  [[nodiscard]] Eigen::Matrix3Xd poses_at(double time) const;

  /// Obstacle n as it is written, and where these poses have it.
  [[nodiscard]] const controller::PlanarShape& shape(std::size_t n) const { return shapes_[n]; }
  [[nodiscard]] controller::PlanarShape shape_at(std::size_t n,
                                                 const Eigen::Matrix3Xd& poses) const;

 private:
  double time_step_;
  std::vector<controller::PlanarShape> shapes_;
  std::vector<Eigen::Matrix3Xd> poses_;
};

}  // namespace qsmpc::harness
