// Which plan the optimisation starts from: the previous one a stage later, constant inputs, or a
// minimum that a search over both halves of the horizon finds.
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
  /// Refers to all three.
  StartChoice(const models::Dynamics& dynamics, const PlannerSettings& settings,
              PlanEvaluator& evaluator);
  StartChoice(const StartChoice&) = delete;
  StartChoice& operator=(const StartChoice&) = delete;
  StartChoice(StartChoice&&) = delete;
  StartChoice& operator=(StartChoice&&) = delete;
  ~StartChoice() = default;

  /// Makes plan.current the start, for the belief that the evaluator has taken, and holds
  /// assignments that may do for it: those of the previous plan, if that is where the start is
  /// from, or else new ones. Sets plan.warm to whether it is.
  /// previous: the plan to go on from, or null; its particles of stage 0 are moved to the belief.
  void choose(const Gaussian& belief, Plan* previous, PlanInProgress& plan);

 private:
  void hold_risk(const Plan* previous, PlanInProgress& plan);
  [[nodiscard]] bool constant_is_clearly_cheaper(const Plan& previous, PlanInProgress& plan);
  void take_best_minimum(PlanInProgress& plan);

  PlanEvaluator& evaluator_;
  Eigen::MatrixXd no_noise_;
  NoiseFreeCost noise_free_;
  FirstGuess guess_;
  std::optional<MultiStartSearch> minima_;  // where there are obstacles, or limits of the risk
  Eigen::MatrixXd gain_change_;
  Eigen::MatrixXd shifted_;
};

}  // namespace qsmpc::controller
