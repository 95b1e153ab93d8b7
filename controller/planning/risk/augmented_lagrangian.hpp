// Few inequality constraints for solvers that take none: the augmented Lagrangian
//     J(z) + Σ_j [max(0, λ_j + ρ c_j(z))² − λ_j²] / 2ρ
// (Hestenes, Powell, Rockafellar), minimised again with λ_j ← max(0, λ_j + ρ c_j) until the
// constraints are kept.
#pragma once

#include <Eigen/Core>

#include "controller/planning/risk/risk_constraint.hpp"

namespace qsmpc::controller {

class AugmentedLagrangian {
 public:
  /// For a plan whose cost is about `cost`, with `constraint`, which must stay alive. warm: goes on
  /// with the multipliers of the last plan, a stage later; else with none.
  void start(RiskConstraint& constraint, double cost, bool warm);

  /// What the constraints add to the cost at z; their part of the gradient is added to it.
  double add(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

  /// New multipliers after a minimisation that ended at z. Returns whether another one should
  /// follow: a constraint is not kept to `tolerance`, or one that has room still pushes.
  [[nodiscard]] bool update(const Eigen::VectorXd& z, double tolerance);

 private:
  RiskConstraint* constraint_ = nullptr;
  Eigen::VectorXd multipliers_;  // λ
  Eigen::VectorXd pushes_;       // max(0, λ + ρ c)
  double weight_ = 1.0;          // ρ
  double last_violation_ = 0.0;
};

}  // namespace qsmpc::controller
