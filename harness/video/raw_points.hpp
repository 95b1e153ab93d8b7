// The points that a prediction compresses, stage by stage, made again from a trace: it holds only
// what they were compressed to.
#pragma once

#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/policy.hpp"
#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

class RawPoints {
 public:
  /// `dynamics`: the planner's model of `scenario`; must outlive it.
  RawPoints(const Scenario& scenario, const models::Dynamics& dynamics);

  /// How many there are in all stages of `step`.
  [[nodiscard]] std::size_t count(const StepRecord& step) const;

  /// Element k - 1: the stepped points f(c_i, u_i) of stage k - 1 under the plan's policy, each
  /// with each point of the noise's product quantiser (or with none where the controller does not
  /// propagate the noise), and the products of their weights. Empty for a step without particles.
  /// Const, and safe from several threads.
  [[nodiscard]] std::vector<controller::DiscreteMeasure> stages(const StepRecord& step) const;

 private:
  [[nodiscard]] controller::Policy policy_of(const StepRecord& step) const;

  const models::Dynamics& dynamics_;
  controller::PlannerSettings settings_;
  controller::DiscreteMeasure noise_;
};

}  // namespace qsmpc::harness
