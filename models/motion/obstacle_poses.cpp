#include "models/motion/obstacle_poses.hpp"

#include <cmath>
#include <numbers>

namespace qsmpc::models {

Eigen::Matrix3Xd poses_between(const Eigen::Matrix3Xd& first, const Eigen::Matrix3Xd& last,
                               double share) {
  Eigen::Matrix3Xd moved = last - first;
  for (double& turn : moved.row(2)) turn = std::remainder(turn, 2.0 * std::numbers::pi);
  return first + share * moved;
}

}  // namespace qsmpc::models
