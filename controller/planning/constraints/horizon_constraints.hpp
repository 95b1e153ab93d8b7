// The constraints of all stages as functions of the solver's decision.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/constraints/stage_constraint.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/risk/risk_constraint.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::controller {

/// c + margin ≤ 0 for each constraint of the stages 1 … horizon, followed by those of the risk.
/// Keeps a reference to the cost.
class HorizonConstraints {
 public:
  HorizonConstraints(HorizonCost& cost, const SafeSet& safe_set);

  /// Sets `out` to the constraints of the prediction that the cost holds. Call it again whenever
  /// the cost holds another one; `out` refers to this object.
  void describe(const Prediction& prediction, ConstraintSet& out);

  /// Adds the limits of the risk, which must stay alive; null: none.
  void set_risk(RiskConstraint* risk) { risk_ = risk; }
  /// How many of the constraints, the first, are on particles.
  [[nodiscard]] Eigen::Index particle_count() const { return particle_count_; }

  /// Tightens the constraints on particles by this much (≥ 0, in the unit of the constraint).
  void set_margin(double margin) { margin_ = margin; }
  [[nodiscard]] double margin() const { return margin_; }

 private:
  /// One group at one stage.
  struct Block {
    Eigen::Index begin;
    Eigen::Index stage;
    Eigen::Index size;
    const StageConstraint* constraint;
    int group;
  };

  void values(const Eigen::VectorXd& z, Eigen::VectorXd& out);
  void some(const Eigen::VectorXd& z, const std::vector<int>& which, Eigen::VectorXd& out,
            Eigen::MatrixXd& gradients);

  HorizonCost& cost_;
  RiskConstraint* risk_ = nullptr;
  Eigen::Index particle_count_ = 0;
  double margin_ = 0.0;
  std::vector<std::unique_ptr<const StageConstraint>> constraints_;
  std::vector<Block> blocks_;
  StageSlope slope_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd multipliers_;
};

}  // namespace qsmpc::controller
