// Chooses the plan that the optimisation starts from: the previous one shifted by a stage, constant
// inputs, or a minimum found by a search over both halves of the horizon.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/cost/noise_free_cost.hpp"
#include "controller/planning/plan_evaluator.hpp"
#include "controller/planning/plan_in_progress.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/start/first_guess.hpp"
#include "controller/planning/start/multi_start_search.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class StartChoice {
 public:
  /// Keeps references to all three.
  StartChoice(const models::Dynamics& dynamics, const PlannerSettings& settings,
              PlanEvaluator& evaluator);
  StartChoice(const StartChoice&) = delete;
  StartChoice& operator=(const StartChoice&) = delete;
  StartChoice(StartChoice&&) = delete;
  StartChoice& operator=(StartChoice&&) = delete;
  ~StartChoice() = default;

  /// Sets plan.current to the start, for the evaluator's current belief, and holds suitable
  /// assignments: those of the previous plan if the start comes from it, or else new ones. Sets
  /// plan.warm to whether it does. previous: the plan to continue, or null; its particles of stage
  /// 0 are moved to the belief.
  void choose(const Gaussian& belief, Plan* previous, PlanInProgress& plan);

 private:
  void hold_risk(const Plan* previous, PlanInProgress& plan);
  [[nodiscard]] bool constant_is_clearly_cheaper(const Plan& previous, PlanInProgress& plan);
  void take_best_minimum(PlanInProgress& plan);

  PlanEvaluator& evaluator_;
  Eigen::MatrixXd no_noise_;
  NoiseFreeCost noise_free_;
  FirstGuess guess_;
  std::optional<MultiStartSearch> minima_;  // with obstacles or risk limits
  Eigen::MatrixXd gain_change_;
  Eigen::MatrixXd shifted_;
};

}  // namespace qsmpc::controller
