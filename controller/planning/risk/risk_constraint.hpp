// The limits of a plan's risk as constraints of its decision, on a logarithmic scale: c ≤ 0 where
// log(risk) is at most log(limit) less a margin. Between certifications the risk is that of
// RiskModel.
#pragma once

#include <chrono>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/risk/risk_limits.hpp"
#include "controller/planning/risk/risk_model.hpp"
#include "controller/planning/solvers/augmented_lagrangian.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class RiskConstraint final : public SummedConstraints {
 public:
  /// Refers to both.
  RiskConstraint(const models::Dynamics& dynamics, const PlannerSettings& settings);

  /// Of the plan that is made in period `period` of a drive, from now on.
  void set_limits(const RiskLimits& limits, Eigen::Index period);
  [[nodiscard]] const RiskLimits& limits() const { return limits_; }

  /// Certifies `policy` from `belief`, and holds its surrogate, calibrated, from now on.
  void certify(const Gaussian& belief, const Policy& policy, PlanRisk& out);
  /// Where `risk`, certified for `policy`, exceeds its limits by the sum of the stages: judges it
  /// by first entries (first_entry.hpp), which are less. Returns whether it is within its limits.
  bool count_entries(const Gaussian& belief, const Policy& policy, PlanRisk& risk) const;
  /// log(certificate / limit) of the limit that `policy` exceeds most; holds nothing.
  [[nodiscard]] double excess(const Gaussian& belief, const Policy& policy) const;
  /// The same of a policy that has been certified (stages 1 … horizon).
  [[nodiscard]] double excess(const std::vector<double>& stages) const;
  /// Holds the surrogate of `policy` with the factors of the last calibration.
  void hold(const Gaussian& belief, const Policy& policy);
  /// For a new plan that goes on from the last, or does not: factors of the calibration move on, or
  /// are forgotten.
  void start(bool warm);

  /// How much more than the limits say is asked for, in logarithms.
  [[nodiscard]] double margin() const { return margin_; }
  void set_margin(double margin) { margin_ = margin; }

  [[nodiscard]] Eigen::Index count() const override { return values_.size(); }
  /// c at a decision.
  const Eigen::VectorXd& values(const Eigen::VectorXd& z) override;
  /// Adds Σ_j multipliers_j ∂c_j/∂z at the decision last asked for.
  void add_gradient(const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient) override;
  /// ½ Σ max(0, c)² and its gradient, which is added, times `scale`.
  double add_excess(const Eigen::VectorXd& z, double scale, Eigen::VectorXd* gradient);
  /// The logarithm of the sum of all stages' risks, and its gradient (overwritten).
  double log_total(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

 private:
  [[nodiscard]] PredictedMotion motion_of(const Gaussian& belief, const Policy& policy) const;
  [[nodiscard]] double excess(const std::vector<double>& stages, double plan) const;
  void judge(PlanRisk& out) const;

  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  UnsafeSet unsafe_;
  RiskModel model_;
  RiskLimits limits_;
  Eigen::Index period_ = 0;
  double margin_ = 0.0;
  Prediction no_particles_;  // of which surrogates need none
  Eigen::VectorXd values_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd multipliers_;
};

}  // namespace qsmpc::controller
