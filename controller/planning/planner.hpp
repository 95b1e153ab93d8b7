// The receding-horizon planner (Algorithm 5): from a Gaussian belief to a policy over the horizon.
//
//   Planner planner(*car, settings);
//   const Plan& plan = planner.plan(belief);
//   Eigen::VectorXd u = policy_input(plan.policy, 0, measured_state);
//
// A planner remembers its last plan, from which the next one is started; apart from that, from the
// timings, and from a deadline if it has one, a plan depends on nothing but settings and beliefs.
// Once it has planned for beliefs of a kind, planning allocates nothing (but for what solvers of
// other people's, the slower propagators and, where the risk is limited, certificates do).
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "controller/planning/assignment_rounds.hpp"
#include "controller/planning/effort_choice.hpp"
#include "controller/planning/plan.hpp"
#include "controller/planning/plan_evaluator.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/start/start_choice.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// What a plan is to be made for, beside the belief.
struct PlanRequest {
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  Eigen::Index period = 0;  ///< of the drive, which decides what the model error is
  /// Limits of this plan's risk beside those of the settings; the lower one counts.
  RiskLimits limits{};
  /// Arc length of the settings' path that the belief is at, m; without it, where its mean is
  /// nearest. Of waypoints how many have been passed; without it, none. Nothing where there are
  /// neither.
  std::optional<double> progress{};
};

class Planner {
 public:
  /// `dynamics` must outlive the planner. Throws std::invalid_argument on settings that make no
  /// sense: sizes, non-finite entries, unknown names, a horizon below 1, a guide without a plane.
  Planner(const models::Dynamics& dynamics, PlannerSettings settings);
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;
  Planner(Planner&&) = delete;
  Planner& operator=(Planner&&) = delete;
  ~Planner() = default;

  /// Plans for `belief` (state_dim; checked, throws std::invalid_argument), until the request's
  /// deadline or that of the settings, whichever is earlier. Numerical trouble, a deadline that has
  /// passed and a limit of the risk that no plan was found for are statuses of the plan, never
  /// exceptions; after a failure the next plan is a cold start. The plan stays valid until the next
  /// call.
  const Plan& plan(const Gaussian& belief, const PlanRequest& request = {});

  /// The plan whose nominal inputs are `inputs` (input_dim x horizon): predicted and evaluated for
  /// `belief`, with the gains that belong to them, and not optimised. The plan stays valid until
  /// the next call, which does not start from it. Throws std::invalid_argument as `plan`, and if
  /// the inputs are of another size, not finite or not within the bounds.
  const Plan& prescribe(const Gaussian& belief, const Eigen::Ref<const Eigen::MatrixXd>& inputs);

  /// The policy of `plan`, another planner's for the same belief, progress (PlanRequest) and
  /// system, as this one predicts and evaluates it. It stays valid as that of `prescribe`. Throws
  /// std::invalid_argument as `plan`.
  const Plan& price(const Gaussian& belief, const Plan& plan, std::optional<double> progress = {});

  /// Quantises a Gaussian of this covariance (state_dim x state_dim), so that the quantiser's slow
  /// first call for beliefs like it is over before a control loop starts. No plan depends on it.
  /// Throws std::invalid_argument as `plan`.
  void prepare(const Eigen::MatrixXd& covariance);

  /// Forgets the last plan: the next one is a cold start.
  void reset() {
    last_ = nullptr;
    failed_ = false;
    kept_inputs_.resize(0, 0);
    effort_.reset();
    if (errorless_) errorless_->reset();
  }

  /// How far it is from `state` to the target the way that the guide knows, or from
  /// `progress` on along the path or over the waypoints, m; empty without any of them.
  [[nodiscard]] std::optional<double> way_to_target(const Eigen::VectorXd& state,
                                                    std::optional<double> progress = {});

  [[nodiscard]] const PlannerSettings& settings() const { return settings_; }
  [[nodiscard]] const Propagator& propagator() const { return evaluator_.propagator(); }
  [[nodiscard]] const models::Dynamics& dynamics() const { return dynamics_; }

 private:
  void set_limits(const PlanRequest& request);
  void begin_prescribed(const Gaussian& belief, std::optional<double> progress);
  void fall_back(Plan& plan);
  void settle(PlanInProgress& plan, const Gaussian& belief, const PlanRequest& request);
  [[nodiscard]] bool begin_effort(const Plan& plan);
  void choose_effort(PlanInProgress& plan);
  void try_tail(PlanInProgress& plan, bool in_any_case);
  void plan_without_error(PlanInProgress& plan, const Gaussian& belief, const PlanRequest& request);

  const models::Dynamics& dynamics_;
  PlannerSettings settings_;
  PlanEvaluator evaluator_;
  StartChoice start_;
  AssignmentRounds rounds_;
  EffortChoice effort_;
  std::array<Plan, 3> plans_;    // the last one, and room for the next and what may replace it
  Plan* last_ = nullptr;         // the plan last made, null for a cold start
  bool failed_ = false;          // the last plan fell back, or its solver met numerical trouble
  Eigen::MatrixXd kept_inputs_;  // of the last plan within its limits, as they go on now; or empty
  Plan prescribed_;
  std::unique_ptr<Planner> errorless_;  // as this one, for the model alone; only for kModel
  bool errorless_goes_on_ = false;      // whether it made the last plan
};

/// What `plan`, which `planner` made for `belief`, predicts; refers to all three.
[[nodiscard]] PredictedMotion motion_of(const Planner& planner, const Gaussian& belief,
                                        const Plan& plan);

}  // namespace qsmpc::controller
