// Inequality constraints for solvers that support none: the augmented Lagrangian
//     J(z) + Σ_j [max(0, λ_j + ρ c_j(z))² − λ_j²] / 2ρ
// (Hestenes, Powell, Rockafellar), minimised again with λ_j ← max(0, λ_j + ρ c_j) until the
// constraints are kept.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

/// Constraints c(z) ≤ 0 for which only weighted sums of gradients are needed, however many there
/// are. They should be scaled so that 1 is the largest acceptable violation on the way to a
/// solution.
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
  /// Adds Σ_j multipliers_j ∂c_j/∂z at the decision of the last call of `values`.
  virtual void add_gradient(const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient) = 0;
};

/// Successive constraints that belong to stages, `of_stage` to each: of count / of_stage stages.
struct StageRows {
  Eigen::Index begin = 0;
  Eigen::Index count = 0;
  Eigen::Index of_stage = 1;
};

class AugmentedLagrangian {
 public:
  /// Starts a plan whose cost is roughly `cost`, with `constraint`, which must stay alive. warm:
  /// continues with the multipliers of the last plan (see `shift`); else they start at zero.
  void start(SummedConstraints& constraint, double cost, bool warm);

  /// Resets the multipliers to 0, but keeps the weight ρ.
  void release() { multipliers_.setZero(); }
  /// Shifts the multipliers of `rows` by one stage; those of the last stage are kept, as are all
  /// others. Does nothing unless there are multipliers for all of them.
  void shift(const StageRows& rows);

  /// Returns the constraints' contribution to the cost at z, and adds its gradient to `gradient`.
  double add(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

  /// New multipliers after a minimisation that ended at z. Returns whether another one should
  /// follow: a constraint is violated by more than `tolerance`, unless a multiplier is exhausted,
  /// or an inactive one still has a significant multiplier.
  [[nodiscard]] bool update(const Eigen::VectorXd& z, double tolerance);

  /// Whether a multiplier has reached its limit, ten times the cost: as far as this method can
  /// tell, the constraints cannot be kept.
  [[nodiscard]] bool exhausted() const {
    return multipliers_.size() > 0 && multipliers_.maxCoeff() >= most_;
  }

 private:
  SummedConstraints* constraint_ = nullptr;
  Eigen::VectorXd multipliers_;  // λ
  Eigen::VectorXd pushes_;       // max(0, λ + ρ c)
  double weight_ = 1.0;          // ρ
  double most_ = 0.0;            // limit of ρ and of every λ
  double last_violation_ = 0.0;
};

}  // namespace qsmpc::controller
