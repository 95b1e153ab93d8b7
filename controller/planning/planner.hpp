// The receding-horizon planner (Algorithm 5): from a Gaussian belief to a policy over the horizon.
//
//   Planner planner(*car, settings);
//   const Plan& plan = planner.plan(belief);
//   Eigen::VectorXd u = policy_input(plan.policy, 0, measured_state);
//
// A planner starts each plan from its last one. Apart from that, timings and a deadline if there is
// one, a plan depends only on settings and beliefs. After the first plans for beliefs of a kind,
// planning allocates nothing (except in third-party solvers, the slower propagators and, with risk
// limits, certificates).
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

/// The inputs of a plan beside the belief.
struct PlanRequest {
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  Eigen::Index period = 0;  ///< of the drive; determines the model error
  /// Risk limits of this plan beside those of the settings; the lower one applies.
  RiskLimits limits{};
  /// Progress of the belief. On the settings' path: arc length, m; if empty, at the place nearest
  /// to its mean. With waypoints: how many have been passed; if empty, none. Leave it empty without
  /// either.
  std::optional<double> progress{};
};

class Planner {
 public:
  /// `dynamics` must outlive the planner. Throws std::invalid_argument on invalid settings: wrong
  /// sizes, non-finite entries, unknown names, a horizon below 1, a guide without a plane.
  Planner(const models::Dynamics& dynamics, PlannerSettings settings);
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;
  Planner(Planner&&) = delete;
  Planner& operator=(Planner&&) = delete;
  ~Planner() = default;

  /// Plans for `belief` (state_dim; checked, throws std::invalid_argument), until the request's
  /// deadline or that of the settings, whichever is earlier. Numerical trouble, a missed deadline
  /// and a risk limit that no plan could keep are statuses of the plan, never exceptions; after a
  /// failure the next plan is a cold start. The plan stays valid until the next call.
  const Plan& plan(const Gaussian& belief, const PlanRequest& request = {});

  /// Plans from `start`, which another planner made for the same belief, progress (PlanRequest) and
  /// system, as `plan` does from the last plan: optimises at the assignments of `start`, keeps what
  /// comes out, and goes on while that pays. Forgets the last plan; the next one starts from the
  /// result. Throws std::invalid_argument as `plan` does.
  const Plan& plan_from(const Gaussian& belief, const Plan& start,
                        std::optional<double> progress = {});

  /// The plan with the nominal inputs `inputs` (input_dim x horizon): predicted and evaluated for
  /// `belief`, with the gains for these inputs, but not optimised. The plan stays valid until the
  /// next call, which does not start from it. Throws std::invalid_argument as `plan` does, and on
  /// inputs of another size, not finite or not within the bounds.
  const Plan& prescribe(const Gaussian& belief, const Eigen::Ref<const Eigen::MatrixXd>& inputs);

  /// Predicts and evaluates the policy of `plan`, made by another planner for the same belief,
  /// progress (PlanRequest) and system. The result stays valid as for `prescribe`. Throws
  /// std::invalid_argument as `plan` does.
  const Plan& price(const Gaussian& belief, const Plan& plan, std::optional<double> progress = {});

  /// Quantises a Gaussian of this covariance (state_dim x state_dim), so that the quantiser's slow
  /// first call for such beliefs happens before a control loop starts. It changes no plan. Throws
  /// std::invalid_argument as `plan` does.
  void prepare(const Eigen::MatrixXd& covariance);

  /// Forgets the last plan: the next one is a cold start.
  void reset() {
    last_ = nullptr;
    failed_ = false;
    kept_inputs_.resize(0, 0);
    effort_.reset();
    if (errorless_) errorless_->reset();
  }

  /// The length of the way from `state` to the target, m: along the guide's way, or from `progress`
  /// on along the path or over the waypoints; empty without any of these.
  [[nodiscard]] std::optional<double> way_to_target(const Eigen::VectorXd& state,
                                                    std::optional<double> progress = {});

  [[nodiscard]] const PlannerSettings& settings() const { return settings_; }
  [[nodiscard]] const Propagator& propagator() const { return evaluator_.propagator(); }
  [[nodiscard]] const models::Dynamics& dynamics() const { return dynamics_; }

 private:
  void set_limits(const PlanRequest& request);
  [[nodiscard]] PlanInProgress begin(const Gaussian& belief, const PlanRequest& request);
  const Plan& finish(PlanInProgress& plan, const Gaussian& belief, const PlanRequest& request);
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
  std::array<Plan, 3> plans_;    // the last one, the next, and its candidate
  Plan* last_ = nullptr;         // the last plan, null for a cold start
  bool failed_ = false;          // the last plan fell back, or its solver met numerical trouble
  Eigen::MatrixXd kept_inputs_;  // of the last plan within its limits, shifted to now; or empty
  Plan prescribed_;
  std::unique_ptr<Planner> errorless_;  // as this one, but without the model error; only for kModel
  bool errorless_goes_on_ = false;      // whether it was run for the last plan
};

/// The motion predicted by `plan`, which `planner` made for `belief`; refers to all three.
[[nodiscard]] PredictedMotion motion_of(const Planner& planner, const Gaussian& belief,
                                        const Plan& plan);

}  // namespace qsmpc::controller
