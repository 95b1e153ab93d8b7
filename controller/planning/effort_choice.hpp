// Chooses the effort of the feedback by certified risk. Stiff gains saturate the inputs, for which
// certificates assume the worst; gentle gains let the noise spread. In between lies the effort for
// which the same inputs have the lowest certified risk.
#pragma once

#include <Eigen/Core>

#include "controller/planning/plan_evaluator.hpp"
#include "controller/planning/planner_settings.hpp"

namespace qsmpc::controller {

class EffortChoice {
 public:
  /// Keeps references to both.
  EffortChoice(const PlannerSettings& settings, PlanEvaluator& evaluator);

  /// Whether there is a choice: LQR gains without a given effort, and risk limits.
  [[nodiscard]] bool applies() const;

  /// Back to an effort of 1, that of the cost itself.
  void reset();

  /// Certifies the inputs of `plan` with every other effort of the ladder, then with the neighbours
  /// of the best, and uses the best one for all gains from now on. Returns whether the effort
  /// changed; `plan` keeps its gains.
  bool search(const Plan& plan);

  /// The same, but only with both neighbours of the present effort.
  bool search_nearby(const Plan& plan);

  /// The same with one neighbour of the present effort, alternating between the upper and the
  /// lower; with none if the plan, whose gains have the present effort, is far below its limits.
  bool follow(const Plan& plan);

 private:
  [[nodiscard]] double least_worth_it(const Plan& plan);
  void try_step(const Plan& plan, int step, double& least);
  [[nodiscard]] bool try_steps(const Plan& plan, int lowest, int highest);
  [[nodiscard]] bool settle(int first);
  [[nodiscard]] double excess_with(const Plan& plan, int step);

  const PlannerSettings& settings_;
  PlanEvaluator& evaluator_;
  int step_ = 0;         // index on the ladder, 0 for an effort of 1
  bool upwards_ = true;  // which neighbour was tried last
  Policy policy_;
};

}  // namespace qsmpc::controller
