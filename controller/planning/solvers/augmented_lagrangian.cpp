#include "controller/planning/solvers/augmented_lagrangian.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qsmpc::controller {
namespace {

// ρ of a cold start, as a share of the cost: c = 1, a risk e times too large, then costs half that
// share.
constexpr double kWeightShare = 0.02;
// ρ grows by kGrowth if a minimisation leaves more than the share kEnough of the last violation.
constexpr double kGrowth = 5.0;
constexpr double kEnough = 0.3;
// ρ stays within these shares of the cost, and every λ below the second.
constexpr double kLeastWeightShare = 1e-3;
constexpr double kMostWeightShare = 10.0;
// An inactive constraint warrants another minimisation if its multiplier times its slack exceeds
// about this share of the cost.
constexpr double kIdlePush = 1e-4;

}  // namespace

void AugmentedLagrangian::start(SummedConstraints& constraint, double cost, bool warm) {
  constraint_ = &constraint;
  last_violation_ = std::numeric_limits<double>::infinity();
  const double scale = std::max(std::abs(cost), 1e-12);
  most_ = kMostWeightShare * scale;
  if (!warm || multipliers_.size() != constraint.count()) {
    multipliers_.setZero(constraint.count());
    weight_ = kWeightShare * scale;
    return;
  }
  weight_ = std::clamp(weight_, kLeastWeightShare * scale, most_);
  multipliers_ = multipliers_.cwiseMin(most_);
}

void AugmentedLagrangian::shift(const StageRows& rows) {
  const Eigen::Index end = rows.begin + rows.count;
  if (end > multipliers_.size()) return;
  for (Eigen::Index j = rows.begin; j + rows.of_stage < end; ++j) {
    multipliers_[j] = multipliers_[j + rows.of_stage];
  }
}

double AugmentedLagrangian::add(const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
  pushes_ = (multipliers_ + weight_ * constraint_->values(z)).cwiseMax(0.0);
  constraint_->add_gradient(pushes_, gradient);
  return (pushes_.squaredNorm() - multipliers_.squaredNorm()) / (2.0 * weight_);
}

bool AugmentedLagrangian::update(const Eigen::VectorXd& z, double tolerance) {
  const Eigen::VectorXd& values = constraint_->values(z);
  if (!values.allFinite()) return false;
  const double violation = values.size() > 0 ? std::max(0.0, values.maxCoeff()) : 0.0;
  double idle = 0.0;
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    if (values[j] < -tolerance) idle = std::max(idle, multipliers_[j] * -values[j]);
  }
  const bool kept = violation <= tolerance;
  // No multiplier keeps constraints that cannot be kept.
  if (!kept && exhausted()) return false;
  multipliers_ = (multipliers_ + weight_ * values).cwiseMax(0.0).cwiseMin(most_);
  if (!kept && violation > kEnough * last_violation_) weight_ = std::min(kGrowth * weight_, most_);
  last_violation_ = violation;
  return !kept || idle > kIdlePush * weight_ / kWeightShare;
}

}  // namespace qsmpc::controller
