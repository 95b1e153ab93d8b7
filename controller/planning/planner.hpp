// The receding-horizon planner (Algorithm 5): from a Gaussian belief to a policy over the horizon.
//
//   Planner planner(*car, settings);
//   const Plan& plan = planner.plan(belief);
//   Eigen::VectorXd u = policy_input(plan.policy, 0, measured_state);
//
// A planner remembers its last plan, from which the next one is started; apart from that, and from
// the timings, a plan depends on nothing but settings and beliefs.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "controller/measure/gaussian_quantiser.hpp"
#include "controller/planning/horizon_cost.hpp"
#include "controller/planning/ocp_solver.hpp"
#include "controller/planning/penalty.hpp"
#include "controller/planning/safe_set.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

struct PlannerSettings {
  int horizon = 8;
  bool closed_loop = true;
  std::optional<Eigen::MatrixXd> feedback_gain;  ///< input_dim x state_dim; else from LQR
  std::string solver = "lbfgs";
  std::string propagator = "compressed";
  QuantiserKind quantiser = QuantiserKind::kProduct;  ///< of the belief
  int state_points = 100;
  int noise_points = 100;
  int compressed_points = 100;
  int max_evaluations = 100;         ///< of the cost, in one plan
  Eigen::MatrixXd noise_covariance;  ///< state_dim x state_dim
  QuadraticCost cost;
  Penalty penalty;
  SafeSet safe_set;
  InputBounds bounds;
};

/// Wall-clock times in milliseconds.
struct PlanTiming {
  double quantise = 0.0;
  double propagate = 0.0;  ///< predictions with new assignments, linearisations
  double optimise = 0.0;   ///< inside the solver
};

struct Plan {
  Policy policy;
  GaussianQuantisation belief;  ///< of stage 0
  Prediction prediction;        ///< under `policy`, with its own assignments
  CostParts cost;               ///< of `prediction`
  SolverStatus status = SolverStatus::kConverged;
  int evaluations = 0;    ///< of cost and gradient
  bool fallback = false;  ///< the solver failed; this is the shifted previous plan
  PlanTiming timing;
};

class Planner {
 public:
  /// `dynamics` must outlive the planner. Throws std::invalid_argument on settings that make no
  /// sense: sizes, non-finite entries, unknown names, a horizon below 1.
  Planner(const Dynamics& dynamics, PlannerSettings settings);

  /// Plans for `belief` (state_dim; checked, throws std::invalid_argument). Numerical trouble is a
  /// status of the plan, never an exception. The plan stays valid until the next call.
  const Plan& plan(const Gaussian& belief);

  /// The plan whose nominal inputs are `inputs` (input_dim x horizon): predicted and priced for
  /// `belief`, with the gains that belong to them, and not optimised. The plan stays valid until
  /// the next call, which does not start from it. Throws std::invalid_argument as `plan`, and if
  /// the inputs are of another size, not finite or not within the bounds.
  const Plan& prescribe(const Gaussian& belief, const Eigen::Ref<const Eigen::MatrixXd>& inputs);

  /// Quantises a Gaussian of this covariance (state_dim x state_dim), so that the quantiser's slow
  /// first call for beliefs like it is over before a control loop starts. No plan depends on it.
  /// Throws std::invalid_argument as `plan`.
  void prepare(const Eigen::MatrixXd& covariance);

  /// Forgets the last plan: the next one is a cold start.
  void reset() { plan_.reset(); }

  [[nodiscard]] const PlannerSettings& settings() const { return settings_; }
  [[nodiscard]] const Propagator& propagator() const { return *propagator_; }
  [[nodiscard]] const Dynamics& dynamics() const { return dynamics_; }

 private:
  [[nodiscard]] GaussianQuantisation quantise_belief(const Gaussian& belief);
  [[nodiscard]] Policy make_policy(const Eigen::VectorXd& start,
                                   const Eigen::MatrixXd& inputs) const;
  [[nodiscard]] Eigen::MatrixXd first_guess(const Gaussian& belief,
                                            const GaussianQuantisation& quantised) const;
  [[nodiscard]] double cost_without_noise(const Gaussian& belief,
                                          const GaussianQuantisation& quantised,
                                          const Eigen::MatrixXd& inputs) const;
  [[nodiscard]] HorizonCostTerms terms(const Eigen::MatrixXd& noise_covariance,
                                       const GaussianQuantisation& belief) const;
  void optimise(const Gaussian& belief, Plan& plan) const;
  [[nodiscard]] CostParts cost_of(const Plan& plan) const;

  const Dynamics& dynamics_;
  PlannerSettings settings_;
  Eigen::MatrixXd predicted_noise_;  ///< what of the noise the prediction carries
  std::unique_ptr<Propagator> propagator_;
  std::unique_ptr<Propagator> noise_free_;
  std::unique_ptr<OcpSolver> solver_;
  std::optional<GaussianQuantisation> last_belief_;  ///< about zero, for `last_covariance_`
  Eigen::MatrixXd last_covariance_;
  std::optional<Plan> plan_;
  Plan prescribed_;
};

/// What `plan`, which `planner` made for `belief`, predicts; refers to all three.
[[nodiscard]] PredictedMotion motion_of(const Planner& planner, const Gaussian& belief,
                                        const Plan& plan);

}  // namespace qsmpc
