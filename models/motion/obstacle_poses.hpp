// Poses of obstacles that move.
#pragma once

#include <Eigen/Core>

namespace qsmpc::models {

/// Poses at a share 0 … 1 of the way between two: offset x, y (m) and turn (rad), 3 x count. It is
/// straight, and turned the shorter way.
[[nodiscard]] Eigen::Matrix3Xd poses_between(const Eigen::Matrix3Xd& first,
                                             const Eigen::Matrix3Xd& last, double share);

}  // namespace qsmpc::models
