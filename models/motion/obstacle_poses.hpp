// Poses of moving obstacles.
#pragma once

#include <Eigen/Core>

namespace qsmpc::models {

/// Poses interpolated between two at a share 0 … 1: offset x, y (m) and turn (rad), 3 x count.
/// Offsets are interpolated linearly, turns the shorter way round.
[[nodiscard]] Eigen::Matrix3Xd poses_between(const Eigen::Matrix3Xd& first,
                                             const Eigen::Matrix3Xd& last, double share);

}  // namespace qsmpc::models
