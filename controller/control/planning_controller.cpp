#include "controller/control/planning_controller.hpp"

namespace qsmpc::controller {

const Decision& PlanningController::decide(const Situation& situation) {
  check_situation(situation, planner_.dynamics().state_dim());
  const RiskLimits limits =
      mission_.limits(situation.belief.mean, planner_.settings().horizon, situation.periods_left,
                      planner_.way_to_target(situation.belief.mean, situation.progress));
  const Plan& plan = planner_.plan(situation.belief, {.deadline = situation.deadline,
                                                      .period = situation.period,
                                                      .limits = limits,
                                                      .progress = situation.progress});
  mission_.spend(plan);
  policy_input(plan.policy, 0, situation.observation, offset_, decision_.input);
  decision_.policy = &plan.policy;
  decision_.particles.emplace(PlannedParticles{.belief = plan.belief,
                                               .prediction = plan.prediction,
                                               .noise_w2 = planner_.propagator().noise_w2()});
  decision_.cost = plan.cost;
  decision_.status = plan.status;
  decision_.evaluations = plan.evaluations;
  decision_.fallback = plan.fallback;
  decision_.risk = plan.risk.stages.empty() ? nullptr : &plan.risk;
  decision_.risk_exceeded = !plan.risk.kept;
  decision_.believed = unsafe_weight(plan.prediction.stages[1], unsafe_, 1, weighing_);
  decision_.timing = plan.timing;
  return decision_;
}

}  // namespace qsmpc::controller
