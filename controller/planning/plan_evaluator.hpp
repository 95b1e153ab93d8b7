// The evaluation of policies from the current belief: the prediction, its cost, and the assignments
// that are held while a solver runs.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/belief_quantiser.hpp"
#include "controller/planning/coarse_cost.hpp"
#include "controller/planning/constraints/horizon_constraints.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/guide/guide.hpp"
#include "controller/planning/plan.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/planning/risk/risk_constraint.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class PlanEvaluator {
 public:
  /// Keeps references to both; the settings must have been checked (check_planner_settings). Throws
  /// std::invalid_argument on an unknown name, and as Guide does.
  PlanEvaluator(const models::Dynamics& dynamics, const PlannerSettings& settings);
  PlanEvaluator(const PlanEvaluator&) = delete;
  PlanEvaluator& operator=(const PlanEvaluator&) = delete;
  PlanEvaluator(PlanEvaluator&&) = delete;
  PlanEvaluator& operator=(PlanEvaluator&&) = delete;
  ~PlanEvaluator() = default;

  /// Sets the current belief, at arc length `progress` of the settings' path, if there is one (if
  /// empty, at the place nearest to the mean). Places the targets of the cost: the same ones for
  /// all particles, so that there is no kink between them. Throws std::invalid_argument as
  /// BeliefQuantiser does.
  void take_belief(const Gaussian& belief, std::optional<double> progress = {});

  /// Sets the plan's policy to the one about `inputs` (input_dim x horizon), with the gains for
  /// these inputs plus `gain_change` (input_dim x state_dim).
  void set_policy(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                  const Eigen::MatrixXd& gain_change, Plan& plan);

  /// Predicts under plan.policy with new assignments, freezes them, and evaluates the cost. With
  /// risk limits, it also certifies the policy and holds its surrogate.
  void predict_and_evaluate(Plan& plan);
  /// The same unless the certificate alone shows that the plan is not `better` than `other`, which
  /// must be evaluated. Returns whether it was predicted; if not, only its risk is known, its
  /// surrogate is held, and the held assignments stay as they are.
  [[nodiscard]] bool predict_if_promising(Plan& plan, const Plan& other);
  /// The same; returns whether the plan is `better` than `other`.
  [[nodiscard]] bool predict_if_better(Plan& plan, const Plan& other) {
    return predict_if_promising(plan, other) && better(plan, other);
  }

  /// Holds the assignments of `prediction`, which must stay alive and unchanged.
  void freeze_assignments(const Prediction& prediction, const Policy& policy);
  /// Holds the assignments and the surrogate of a plan that has been predicted.
  void hold(Plan& plan);
  /// Whether the plan's assignments can be held for the current belief.
  [[nodiscard]] bool can_freeze(const Plan& plan) const;
  /// The plan's cost under the held assignments.
  [[nodiscard]] double evaluate_frozen(const Plan& plan);

  /// The cost with few points, matched at the plan to the cost with all of them and the held
  /// assignments; null if it does not pay, cannot be matched, or the solver takes constraints.
  [[nodiscard]] CoarseCost* coarse_about(const Plan& plan);

  /// The risk limits; null if there are none.
  [[nodiscard]] RiskConstraint* risk() { return risk_ ? &*risk_ : nullptr; }
  /// Sets the limits of the plan made in period `period` of a drive.
  void set_limits(const RiskLimits& limits, Eigen::Index period);
  /// How far the plan's inputs, with their present gains, exceed the aims of the limits (which must
  /// exist): log(certificate / aim) of the aim exceeded most. policy: scratch.
  [[nodiscard]] double excess_of(const Plan& plan, Policy& policy);
  /// Counts a plan within the limits (which must exist) as kept, also if it is not within the aims.
  void accept_risk(Plan& plan);
  /// Holds the surrogate of this policy for the current belief; does nothing without limits.
  void hold_risk(const Policy& policy);

  /// Switches to a cost of moving at all or back to that of the settings. Held assignments must be
  /// held again afterwards.
  void set_braking(bool braking);

  [[nodiscard]] HorizonCost& cost() { return cost_; }
  [[nodiscard]] PolicyMaker& policies() { return policies_; }
  [[nodiscard]] BeliefQuantiser& quantiser() { return quantiser_; }
  /// The guide round obstacles, if the settings ask for one.
  [[nodiscard]] std::optional<Guide>& guide() { return guide_; }
  /// The current belief as particles.
  [[nodiscard]] const GaussianQuantisation& belief() const { return belief_; }
  /// The cost's weights, about the target nearest to the belief, or the guide's aim in its place.
  [[nodiscard]] const QuadraticCost& weights() const { return weights_; }
  [[nodiscard]] const Propagator& propagator() const { return *propagator_; }
  /// The constraints of stage_constraint.hpp, at the held assignments; empty unless the solver
  /// takes constraints.
  [[nodiscard]] const std::optional<ConstraintSet>& constraints() const { return constraint_set_; }
  /// By how much the constraints are tightened.
  [[nodiscard]] double margin() const { return constraints_.margin(); }
  void set_margin(double margin) { constraints_.set_margin(margin); }
  /// Duration of the last prediction, including its evaluation.
  [[nodiscard]] std::chrono::duration<double> prediction_time() const { return prediction_time_; }

 private:
  void certify(Plan& plan);
  void predict_certified(Plan& plan);
  void flatten(const Policy& policy);
  void place_target();

  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  QuadraticCost weights_;
  Penalty penalty_;                  // the penalties that are part of the cost
  Eigen::MatrixXd predicted_noise_;  // the noise that the prediction carries
  Eigen::MatrixXd within_;           // covariance that the belief's quantiser loses
  BeliefQuantiser quantiser_;
  std::unique_ptr<Propagator> propagator_;
  PolicyMaker policies_;
  HorizonCost cost_;
  std::optional<CoarseCost> coarse_;
  HorizonConstraints constraints_;
  std::optional<ConstraintSet> constraint_set_;
  PredictionScratch scratch_;
  Eigen::VectorXd constraint_values_;
  Eigen::VectorXd z_;  // input_dim * horizon
  Eigen::VectorXd gradient_;
  Gaussian gaussian_;  // the current belief
  std::optional<double> progress_;
  GaussianQuantisation belief_;
  std::optional<RiskConstraint> risk_;
  std::optional<Guide> guide_;
  std::chrono::duration<double> prediction_time_{0.0};
};

}  // namespace qsmpc::controller
