// A controller that plans for the belief in every period, and applies the first stage of the policy
// to the observation.
#pragma once

#include "controller/control/controller.hpp"
#include "controller/control/mission_budget.hpp"
#include "controller/planning/planner.hpp"
#include "controller/regions/unsafe_weight.hpp"

namespace qsmpc::controller {

class PlanningController final : public Controller {
 public:
  /// `dynamics` must outlive it. Throws std::invalid_argument as Planner does.
  PlanningController(const models::Dynamics& dynamics, const ControllerSettings& settings)
      : planner_(dynamics, settings.problem),
        mission_(dynamics, settings.mission, settings.problem.cost.target),
        unsafe_(settings.problem.safe_set) {}

  [[nodiscard]] static DecisionParts parts(const ControllerSettings& settings) {
    return {.stages = settings.problem.horizon,
            .particles = true,
            .noise = propagator_entry(settings.problem.propagator).carries_noise,
            .cost = true,
            .status = true};
  }

  const Decision& decide(const Situation& situation) override;
  using Controller::reset;
  void reset(std::uint64_t /*seed*/) override {
    planner_.reset();
    mission_.reset();
  }

 private:
  Planner planner_;
  MissionBudget mission_;
  UnsafeSet unsafe_;
  UnsafeWeightScratch weighing_;
  Eigen::VectorXd offset_;  // of the observation from the nominal state
  Decision decision_;
};

}  // namespace qsmpc::controller
