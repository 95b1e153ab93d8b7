// The points that a prediction compresses, stage by stage, made again for the one overlay that
// shows them: a trace holds only what they were compressed to, for they are as many times more as
// the noise has points. This alone of what draws an episode builds the planner's model.
#pragma once

#include <memory>
#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/policy.hpp"
#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

class RawPoints {
 public:
  /// Throws std::invalid_argument when the system of `scenario` is unknown.
  explicit RawPoints(const Scenario& scenario);

  /// How many there are in all stages of `step`.
  [[nodiscard]] std::size_t count(const StepRecord& step) const;

  /// Element k - 1: the stepped points f(c_i, u_i) of stage k - 1 under the plan's policy, each
  /// with each point of the noise's product quantiser (or with none where the controller does not
  /// propagate the noise), and the products of their weights. Empty for a step without particles.
  /// Const, and safe from several threads.
  [[nodiscard]] std::vector<controller::DiscreteMeasure> stages(const StepRecord& step) const;

 private:
  [[nodiscard]] controller::Policy policy_of(const StepRecord& step) const;

  std::unique_ptr<const models::Dynamics> model_;
  controller::PlannerSettings settings_;
  controller::DiscreteMeasure noise_;
};

}  // namespace qsmpc::harness
