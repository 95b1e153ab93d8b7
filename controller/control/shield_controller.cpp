// A shield about another controller: if the certified probability that its policy is unsafe at any
// stage of the look-ahead exceeds a limit, it is overruled by a plan certified within the limit or,
// if none is found, the plan with the lowest certificate (after Alshiekh et al.: "Safe
// reinforcement learning via shielding", 2018, with a certificate in place of a model checker).
//
// Looking at the next state alone is not enough: a vehicle has to turn before it can move aside.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "controller/control/controller.hpp"
#include "controller/control/controller_entries.hpp"
#include "controller/control/path_cost.hpp"
#include "controller/planning/cost/placed_target.hpp"
#include "controller/planning/planner.hpp"
#include "controller/planning/risk/risk_constraint.hpp"

namespace qsmpc::controller {
namespace {

constexpr const char* kShield = "shield";

/// Settings for a plan within the limit or, failing that, of least risk.
PlannerSettings evasion(const ControllerSettings& settings) {
  PlannerSettings problem = settings.problem;
  if (settings.shield.stages > 0) problem.horizon = settings.shield.stages;
  problem.risk = {.plan = settings.shield.limit};
  problem.otherwise = RiskOtherwise::kLeastRisk;
  return problem;
}

class Shield final : public Controller {
 public:
  Shield(const models::Dynamics& dynamics, const ControllerSettings& settings)
      : dynamics_(dynamics),
        limit_(settings.shield.limit),
        cost_(settings.problem.cost),
        bounds_(settings.problem.bounds),
        evasion_(evasion(settings)),
        inner_(make_controller(settings.shield.of, dynamics, settings)),
        risk_(dynamics, evasion_),
        evader_(dynamics, evasion_) {}

  const Decision& decide(const Situation& situation) override {
    const Decision& inner = inner_->decide(situation);
    decision_.input = inner.input;
    decision_.evaluations = inner.evaluations;
    decision_.believed = inner.believed;
    decision_.timing = inner.timing;
    decision_.status = inner.status.value_or(SolverStatus::kConverged);
    decision_.risk_exceeded = false;
    take_policy(inner, situation);
    if (certified_risk(situation) > limit_) overrule(situation);
    place_target(evasion_, dynamics_.description(), situation.belief.mean, situation.progress,
                 cost_);
    decision_.cost = path_cost(policy_, cost_, cost_scratch_);
    decision_.policy = &policy_;
    return decision_;
  }

  using Controller::reset;
  void reset(std::uint64_t seed) override {
    inner_->reset(seed);
    evader_.reset();
  }

  [[nodiscard]] std::string log() const override { return inner_->log(); }

 private:
  /// Takes the inner controller's policy; if it has none, its input held over the look-ahead.
  void take_policy(const Decision& inner, const Situation& situation) {
    if (inner.policy != nullptr) {
      policy_ = *inner.policy;
      return;
    }
    policy_.bounds = bounds_;
    policy_.inputs = inner.input.replicate(1, evasion_.horizon);
    policy_.gains.assign(static_cast<std::size_t>(evasion_.horizon),
                         Eigen::MatrixXd::Zero(dynamics_.input_dim(), dynamics_.state_dim()));
    nominal_states(dynamics_, situation.belief.mean, policy_.inputs, policy_.states);
  }

  /// Certified probability of being unsafe at any stage of the look-ahead, as far as the policy
  /// reaches.
  [[nodiscard]] double certified_risk(const Situation& situation) {
    const Eigen::Index stages = std::min<Eigen::Index>(evasion_.horizon, policy_.horizon());
    ahead_.bounds = policy_.bounds;
    ahead_.inputs = policy_.inputs.leftCols(stages);
    ahead_.states = policy_.states.leftCols(stages + 1);
    ahead_.gains.assign(policy_.gains.begin(), policy_.gains.begin() + stages);
    risk_.set_limits({.plan = limit_}, situation.period);
    risk_.certify(situation.belief, ahead_, certified_);
    return certified_.plan;
  }

  /// Replaces the policy by a plan with a lower certificate, if there is one.
  void overrule(const Situation& situation) {
    const Plan& plan = evader_.plan(situation.belief, {.deadline = situation.deadline,
                                                       .period = situation.period,
                                                       .progress = situation.progress});
    decision_.evaluations += plan.evaluations;
    decision_.timing.optimise += plan.timing.optimise;
    decision_.timing.propagate += plan.timing.propagate;
    const bool less = !plan.risk.stages.empty() && plan.risk.plan < certified_.plan;
    decision_.risk_exceeded = !less || !plan.risk.kept;
    if (decision_.risk_exceeded) decision_.status = SolverStatus::kRiskExceeded;
    if (!less) return;
    decision_.believed = plan.risk.stages.front();  // its certificate
    const Eigen::Index stages = std::min(policy_.horizon(), plan.policy.horizon());
    policy_.inputs.leftCols(stages) = plan.policy.inputs.leftCols(stages);
    std::copy_n(plan.policy.gains.begin(), stages, policy_.gains.begin());
    nominal_states(dynamics_, situation.belief.mean, policy_.inputs, policy_.states);
    policy_input(policy_, 0, situation.observation, offset_, decision_.input);
  }

  const models::Dynamics& dynamics_;
  double limit_;
  QuadraticCost cost_;  // about the target of the inner controller's plan
  InputBounds bounds_;
  PlannerSettings evasion_;
  std::unique_ptr<Controller> inner_;
  RiskConstraint risk_;
  Planner evader_;
  Policy policy_;
  Policy ahead_;
  PlanRisk certified_;
  PathCostScratch cost_scratch_;
  Eigen::VectorXd offset_;
  Decision decision_;
};

void check_shielded(const ControllerSettings& settings) {
  if (settings.shield.of == kShield) {
    throw std::invalid_argument("shield: the shielded controller must not be a shield itself");
  }
  if (!(settings.shield.limit > 0.0 && settings.shield.limit <= 1.0)) {
    throw std::invalid_argument("shield: the limit must be above 0 and at most 1");
  }
  if (settings.shield.stages < 0) {
    throw std::invalid_argument("shield: the number of stages must not be negative");
  }
}

}  // namespace

ControllerEntry shield_controller() {
  return {.name = kShield,
          .summary = "overrules another controller whose certified risk exceeds a limit",
          .parts = [](const ControllerSettings& settings) -> DecisionParts {
            check_shielded(settings);
            const DecisionParts inner = controller_entry(settings.shield.of).parts(settings);
            const int stages = inner.stages > 0 ? inner.stages : evasion(settings).horizon;
            return {.stages = stages, .cost = true, .status = true};
          },
          .make = [](const models::Dynamics& dynamics,
                     const ControllerSettings& settings) -> std::unique_ptr<Controller> {
            check_shielded(settings);
            check_planner_settings(settings.problem, dynamics.state_dim(), dynamics.input_dim());
            return std::make_unique<Shield>(dynamics, settings);
          },
          .takes_guide = true};
}

}  // namespace qsmpc::controller
