#include "controller/planning/cost/angular_target.hpp"

#include <cmath>
#include <numbers>

namespace qsmpc::controller {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;  // rad

}  // namespace

void nearest_target(const Eigen::Ref<const Eigen::VectorXd>& target, const std::vector<int>& angles,
                    const Eigen::Ref<const Eigen::VectorXd>& state, Eigen::VectorXd& out) {
  out = target;
  for (const int i : angles) out[i] += kTurn * std::round((state[i] - target[i]) / kTurn);
}

Eigen::VectorXd target_offset(const Eigen::Ref<const Eigen::VectorXd>& target,
                              const std::vector<int>& angles,
                              const Eigen::Ref<const Eigen::VectorXd>& state) {
  Eigen::VectorXd nearest(target.size());
  nearest_target(target, angles, state, nearest);
  return state - nearest;
}

}  // namespace qsmpc::controller
