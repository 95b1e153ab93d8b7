#include "controller/control/mission_budget.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Typical ratio of the way to the target to the straight line.
constexpr double kDetour = 1.2;
// Regularises spent / planned: until the planned risk exceeds about this share of the limit, nearly
// all of it counts as spent.
constexpr double kUntold = 0.01;
// Cap on the share of the remaining budget that a plan gets on that account: in a bad case, the
// next stage alone may need several times the plan's risk.
constexpr double kMostPromised = 0.25;

Eigen::Vector2d position_of(const models::SystemDescription& system,
                            const Eigen::Ref<const Eigen::VectorXd>& state) {
  return {state[system.position_x], state[system.position_y]};
}

bool has_position(const models::SystemDescription& system) {
  return system.position_x >= 0 && system.position_y >= 0;
}

}  // namespace

MissionBudget::MissionBudget(const models::Dynamics& dynamics, double limit,
                             const Eigen::VectorXd& target)
    : dynamics_(dynamics), limit_(limit), target_(target) {}

void MissionBudget::reset() {
  spent_ = 0.0;
  planned_ = 0.0;
  progress_ = 0.0;
}

double MissionBudget::spent_of_planned() const {
  const double untold = kUntold * limit_;
  if (!(untold > 0.0)) return 1.0;
  return std::min(1.0, (spent_ + untold) / (planned_ + untold));
}

double MissionBudget::expected_periods(const Eigen::VectorXd& mean,
                                       std::optional<double> way) const {
  const models::SystemDescription& system = dynamics_.description();
  if (!has_position(system) || !(progress_ > 0.0)) return kInfinity;
  const double straight = (position_of(system, mean) - position_of(system, target_)).norm();
  return std::ceil(way.value_or(kDetour * straight) / progress_);
}

RiskLimits MissionBudget::limits(const Eigen::VectorXd& mean, Eigen::Index horizon,
                                 Eigen::Index periods_left, std::optional<double> way) const {
  RiskLimits limits;
  if (std::isinf(limit_)) return limits;
  const double left = std::max(0.0, limit_ - spent_);
  const double ahead = static_cast<double>(horizon);
  const double periods = std::min(expected_periods(mean, way),
                                  static_cast<double>(std::max<Eigen::Index>(1, periods_left)));
  limits.first = left;
  const double share = std::min(1.0, ahead / periods);
  limits.plan = left * std::max(share, std::min(kMostPromised, share / spent_of_planned()));
  return limits;
}

void MissionBudget::spend(const Plan& plan) {
  const std::vector<double>& stages = plan.risk.stages;
  if (!stages.empty()) {
    spent_ += stages.front();
    const double planned = std::accumulate(stages.begin(), stages.end(), 0.0);
    // A plan that could not keep its limits is capped: it says nothing about plans that do.
    planned_ += std::min(planned, limit_) / static_cast<double>(stages.size());
  }
  const models::SystemDescription& system = dynamics_.description();
  if (!has_position(system)) return;
  double length = 0.0;
  const Eigen::MatrixXd& path = plan.policy.states;
  for (Eigen::Index k = 0; k + 1 < path.cols(); ++k) {
    length += (position_of(system, path.col(k + 1)) - position_of(system, path.col(k))).norm();
  }
  progress_ = length / static_cast<double>(plan.policy.horizon());
}

}  // namespace qsmpc::controller
