// Inequality constraints for solvers that take none: the augmented Lagrangian
//     J(z) + Σ_j [max(0, λ_j + ρ c_j(z))² − λ_j²] / 2ρ
// (Hestenes, Powell, Rockafellar), minimised again with λ_j ← max(0, λ_j + ρ c_j) until the
// constraints are kept.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

/// Constraints c(z) ≤ 0 of which only sums of gradients are asked for, however many there are. They
/// should be scaled so that 1 is as much beyond a constraint as a solution may pass on its way.
class SummedConstraints {
 public:
  SummedConstraints() = default;
  SummedConstraints(const SummedConstraints&) = delete;
  SummedConstraints& operator=(const SummedConstraints&) = delete;
  SummedConstraints(SummedConstraints&&) = delete;
  SummedConstraints& operator=(SummedConstraints&&) = delete;
  virtual ~SummedConstraints() = default;

  [[nodiscard]] virtual Eigen::Index count() const = 0;
  /// c at a decision; valid until the next call.
  virtual const Eigen::VectorXd& values(const Eigen::VectorXd& z) = 0;
  /// Adds Σ_j multipliers_j ∂c_j/∂z at the decision last asked for.
  virtual void add_gradient(const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient) = 0;
};

class AugmentedLagrangian {
 public:
  /// For a plan whose cost is about `cost`, with `constraint`, which must stay alive. warm: goes on
  /// with the multipliers of the last plan, a stage later; else with none.
  void start(SummedConstraints& constraint, double cost, bool warm);

  /// Multipliers of 0, at the weight that the constraints have come to.
  void release() { multipliers_.setZero(); }
  /// The multipliers, for constraints of which `of_stage` stand for each stage, move on by one
  /// stage; those of the last are held.
  void shift(Eigen::Index of_stage);

  /// What the constraints add to the cost at z; their part of the gradient is added to it.
  double add(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

  /// New multipliers after a minimisation that ended at z. Returns whether another one should
  /// follow: a constraint is not kept to `tolerance`, or one that has room still pushes.
  [[nodiscard]] bool update(const Eigen::VectorXd& z, double tolerance);

 private:
  SummedConstraints* constraint_ = nullptr;
  Eigen::VectorXd multipliers_;  // λ
  Eigen::VectorXd pushes_;       // max(0, λ + ρ c)
  double weight_ = 1.0;          // ρ
  double last_violation_ = 0.0;
};

}  // namespace qsmpc::controller
