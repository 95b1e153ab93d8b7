// What a policy leads to from the belief at hand: the prediction, its cost, and the assignments
// that are held while a solver works.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/belief_quantiser.hpp"
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
  /// Refers to both, which must be checked (check_planner_settings). Throws std::invalid_argument
  /// on an unknown name, and as Guide.
  PlanEvaluator(const models::Dynamics& dynamics, const PlannerSettings& settings);
  PlanEvaluator(const PlanEvaluator&) = delete;
  PlanEvaluator& operator=(const PlanEvaluator&) = delete;
  PlanEvaluator(PlanEvaluator&&) = delete;
  PlanEvaluator& operator=(PlanEvaluator&&) = delete;
  ~PlanEvaluator() = default;

  /// Everything that follows is for this belief, at arc length `progress` of the settings' path
  /// where there is one (without it, where the mean is nearest). Places the targets that the cost
  /// is about: the same ones for all particles, so that there is no kink between them. Throws
  /// std::invalid_argument as BeliefQuantiser.
  void take_belief(const Gaussian& belief, std::optional<double> progress = {});

  /// Makes the plan's policy the one about `inputs` (input_dim x horizon), with the gains that
  /// belong to them, changed by `gain_change` (input_dim x state_dim).
  void set_policy(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                  const Eigen::MatrixXd& gain_change, Plan& plan);

  /// Predicts under plan.policy with assignments of its own, freezes them, and evaluates the cost;
  /// where there are limits of the risk, certifies it and holds its surrogate, too.
  void predict_and_evaluate(Plan& plan);

  /// Holds these assignments from now on; `prediction` must stay alive and unchanged.
  void freeze_assignments(const Prediction& prediction, const Policy& policy);
  /// Holds the assignments of a plan that has been predicted, and its surrogate.
  void hold(Plan& plan);
  /// Whether the plan's assignments can be held for the belief at hand.
  [[nodiscard]] bool can_freeze(const Plan& plan) const;
  /// What the assignments that are held say of the plan's cost.
  [[nodiscard]] double evaluate_frozen(const Plan& plan);

  /// The limits of the risk, where there are any.
  [[nodiscard]] RiskConstraint* risk() { return risk_ ? &*risk_ : nullptr; }
  /// Limits of the plan that is made in period `period` of a drive.
  void set_limits(const RiskLimits& limits, Eigen::Index period);
  /// How far the plan's inputs, with the gains that belong to them now, exceed the limits, which
  /// there must be: log(certificate / limit) of the limit that is exceeded most. `policy` is room
  /// for theirs.
  [[nodiscard]] double excess_of(const Plan& plan, Policy& policy);
  /// Judges a plan that exceeds the limits, which there must be, by first entries.
  void count_entries(Plan& plan);
  /// Holds the surrogate of this policy for the belief at hand; without limits, nothing.
  void hold_risk(const Policy& policy);

  /// Whether the cost is, from now on, that of moving at all; else what the settings say again.
  /// Assignments that are held have to be held anew.
  void set_braking(bool braking);

  [[nodiscard]] HorizonCost& cost() { return cost_; }
  [[nodiscard]] PolicyMaker& policies() { return policies_; }
  [[nodiscard]] BeliefQuantiser& quantiser() { return quantiser_; }
  /// What knows the way round obstacles, where the settings ask for it.
  [[nodiscard]] std::optional<Guide>& guide() { return guide_; }
  /// The belief at hand as particles.
  [[nodiscard]] const GaussianQuantisation& belief() const { return belief_; }
  /// The cost's weights, about the target that is nearest to the belief, or about what a guide puts
  /// in its place.
  [[nodiscard]] const QuadraticCost& weights() const { return weights_; }
  [[nodiscard]] const Propagator& propagator() const { return *propagator_; }
  /// Those of stage_constraint.hpp, at the assignments held; empty unless the solver takes any.
  [[nodiscard]] const std::optional<ConstraintSet>& constraints() const { return constraint_set_; }
  /// How much more than they say is asked of the constraints.
  [[nodiscard]] double margin() const { return constraints_.margin(); }
  void set_margin(double margin) { constraints_.set_margin(margin); }
  /// How long the last prediction took, with its evaluation.
  [[nodiscard]] std::chrono::duration<double> prediction_time() const { return prediction_time_; }

 private:
  void flatten(const Policy& policy);
  void place_target();

  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  QuadraticCost weights_;
  Penalty penalty_;                  // what of the penalties is left to the cost
  Eigen::MatrixXd predicted_noise_;  // what of the noise the prediction carries
  Eigen::MatrixXd within_;           // covariance that the belief's quantiser loses
  BeliefQuantiser quantiser_;
  std::unique_ptr<Propagator> propagator_;
  PolicyMaker policies_;
  HorizonCost cost_;
  HorizonConstraints constraints_;
  std::optional<ConstraintSet> constraint_set_;
  PredictionScratch scratch_;
  Eigen::VectorXd constraint_values_;
  Eigen::VectorXd z_;  // input_dim * horizon
  Gaussian gaussian_;  // the belief at hand
  std::optional<double> progress_;
  GaussianQuantisation belief_;
  std::optional<RiskConstraint> risk_;
  std::optional<Guide> guide_;
  std::chrono::duration<double> prediction_time_{0.0};
};

}  // namespace qsmpc::controller
