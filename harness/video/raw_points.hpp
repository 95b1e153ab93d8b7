// The points that a prediction compresses, stage by stage, recomputed for the one overlay that
// shows them. A trace holds only the compressed points; the raw ones are more by a factor of the
// number of noise points. This is the only drawing code that builds the planner's model.
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
  /// Throws std::invalid_argument if the system of `scenario` is unknown.
  explicit RawPoints(const Scenario& scenario);

  /// The number of points in all stages of `step`.
  [[nodiscard]] std::size_t count(const StepRecord& step) const;

  /// Element k - 1: the stepped points f(c_i, u_i) of stage k - 1 under the plan's policy, each
  /// combined with every point of the noise's product quantiser (or with none if the controller
  /// does not propagate the noise), and the products of their weights. Empty for a step without
  /// particles. May be called from several threads concurrently.
  [[nodiscard]] std::vector<controller::DiscreteMeasure> stages(const StepRecord& step) const;

 private:
  [[nodiscard]] controller::Policy policy_of(const StepRecord& step) const;

  std::unique_ptr<const models::Dynamics> model_;
  controller::PlannerSettings settings_;
  controller::DiscreteMeasure noise_;
};

}  // namespace qsmpc::harness
