// How much effort feedback may take, chosen by what is certified. Stiff gains meet the bounds of
// the input, of which certificates make the worst; gentle ones let the noise spread. Between them
// is the effort for which the same inputs are certified to the least risk.
#pragma once

#include <Eigen/Core>

#include "controller/planning/plan_evaluator.hpp"
#include "controller/planning/planner_settings.hpp"

namespace qsmpc::controller {

class EffortChoice {
 public:
  /// Refers to both.
  EffortChoice(const PlannerSettings& settings, PlanEvaluator& evaluator);

  /// Whether there is anything to choose: gains from LQR whose effort is not given, and limits.
  [[nodiscard]] bool applies() const;

  /// Back to the effort of the cost itself.
  void reset();

  /// Certifies the inputs of `plan` with efforts of the whole ladder, and makes the best one that
  /// of all gains from now on. Returns whether it is another one; `plan` keeps its gains.
  bool search(const Plan& plan);

  /// The same with both neighbours of the effort at hand alone.
  bool search_nearby(const Plan& plan);

  /// The same with one neighbour of the effort at hand, the upper and the lower in turn; with none
  /// where the plan, whose gains are of the effort at hand, stays far below its limits.
  bool follow(const Plan& plan);

 private:
  bool try_steps(const Plan& plan, int lowest, int highest);
  [[nodiscard]] double excess_with(const Plan& plan, int step);

  const PlannerSettings& settings_;
  PlanEvaluator& evaluator_;
  int step_ = 0;         // of the ladder, 0 for an effort of 1
  bool upwards_ = true;  // which neighbour was tried last
  Policy policy_;
};

}  // namespace qsmpc::controller
