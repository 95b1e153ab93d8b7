// The limits of a plan's risk as constraints of its decision, on a logarithmic scale: c ≤ 0 where
// log(risk) is at most log(aim) less a margin. Aims are the limits less the reserve that later
// plans may need (docs/theory/planning.md, "Risk"). Between certifications the risk is that of
// RiskModel.
#pragma once

#include <chrono>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/risk/recent_bounds.hpp"
#include "controller/planning/risk/risk_limits.hpp"
#include "controller/planning/risk/risk_model.hpp"
#include "controller/planning/solvers/augmented_lagrangian.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class RiskConstraint final : public SummedConstraints {
 public:
  /// Keeps references to both.
  RiskConstraint(const models::Dynamics& dynamics, const PlannerSettings& settings);

  /// Sets the limits of the plan made in period `period` of a drive.
  void set_limits(const RiskLimits& limits, Eigen::Index period);
  [[nodiscard]] const RiskLimits& limits() const { return limits_; }
  /// To be called before each plan: the laws of moving obstacles may have changed.
  void begin() { bounds_.forget(); }

  /// Certifies `policy` from `belief`, and holds its calibrated surrogate. `out.kept` says whether
  /// it is within the aims.
  void certify(const Gaussian& belief, const Policy& policy, PlanRisk& out);
  /// Whether `risk`, certified for `policy`, is within the limits, if not within the aims: by the
  /// sum over the stages or by the tighter first-entry bounds (first_entry.hpp). If so, it then
  /// counts as kept.
  bool accept(const Gaussian& belief, const Policy& policy, PlanRisk& risk);
  /// log(certificate / aim) of the aim that `policy` exceeds most; does not change the held
  /// surrogate.
  [[nodiscard]] double excess(const Gaussian& belief, const Policy& policy);
  /// The same for the certificates of a policy (stages 1 … horizon).
  [[nodiscard]] double excess(const std::vector<double>& stages) const;
  /// Holds the surrogate of `policy` with the factors of the last calibration.
  void hold(const Gaussian& belief, const Policy& policy);
  /// Prepares for a new plan. warm: it continues the last one, and the calibration factors are
  /// shifted by one stage; else they are forgotten.
  void start(bool warm);

  /// By how much the aims are tightened, in log risk.
  [[nodiscard]] double margin() const { return margin_; }
  void set_margin(double margin) { margin_ = margin; }

  [[nodiscard]] Eigen::Index count() const override { return values_.size(); }
  /// The constraints that limit one stage each, in the order of the stages; none without a limit of
  /// all stages.
  [[nodiscard]] StageRows stage_rows() const;
  /// c at a decision.
  const Eigen::VectorXd& values(const Eigen::VectorXd& z) override;
  /// Adds Σ_j multipliers_j ∂c_j/∂z at the decision of the last call of `values`.
  void add_gradient(const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient) override;
  /// `scale` times ½ Σ max(0, c)²; adds its gradient unless null.
  double add_excess(const Eigen::VectorXd& z, double scale, Eigen::VectorXd* gradient);
  /// The logarithm of the sum of all stages' risks, and its gradient (overwritten).
  double log_total(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

 private:
  [[nodiscard]] PredictedMotion motion_of(const Gaussian& belief, const Policy& policy) const;
  void judge(PlanRisk& out) const;

  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  UnsafeSet unsafe_;
  RecentBounds bounds_;
  RiskModel model_;
  RiskLimits limits_;
  RiskLimits aims_;  ///< finite where the limits are
  Eigen::Index period_ = 0;
  double margin_ = 0.0;
  Prediction no_particles_;  // surrogates need none
  Eigen::VectorXd values_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd multipliers_;
};

}  // namespace qsmpc::controller
