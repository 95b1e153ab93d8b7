#include "harness/trace/residuals.hpp"

#include <cstddef>

namespace qsmpc::harness {

Eigen::MatrixXd true_states(const Trace& trace) {
  const bool ended = trace.final_state.size() > 0;
  const auto steps = static_cast<Eigen::Index>(trace.steps.size());
  const Eigen::Index dim = ended       ? trace.final_state.size()
                           : steps > 0 ? trace.steps.front().state.size()
                                       : 0;
  Eigen::MatrixXd states(dim, steps + (ended ? 1 : 0));
  for (Eigen::Index k = 0; k < steps; ++k) {
    states.col(k) = trace.steps[static_cast<std::size_t>(k)].state;
  }
  if (ended) states.col(steps) = trace.final_state;
  return states;
}

Eigen::Index completed_periods(const Trace& trace) {
  const auto steps = static_cast<Eigen::Index>(trace.steps.size());
  const bool end_is_known = trace.final_state.size() > 0 && trace.outcome != Outcome::kFault;
  return end_is_known || steps == 0 ? steps : steps - 1;
}

Eigen::MatrixXd one_step_residuals(const Trace& trace, const models::Dynamics& model) {
  const Eigen::MatrixXd states = true_states(trace);
  const Eigen::Index periods = completed_periods(trace);
  Eigen::MatrixXd residuals(model.state_dim(), periods);
  models::StateBatch predicted(model.state_dim(), 1);
  for (Eigen::Index k = 0; k < periods; ++k) {
    const StepRecord& step = trace.steps[static_cast<std::size_t>(k)];
    const models::StateBatch state = states.col(k);
    const models::StateBatch input = step.input;
    model.step(state, input, predicted);
    residuals.col(k) = states.col(k + 1) - step.disturbance - predicted.col(0);
  }
  return residuals;
}

}  // namespace qsmpc::harness
