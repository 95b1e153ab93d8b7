#include "harness/trace/episode_view.hpp"

#include "controller/regions/unsafe_set.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/trace/residuals.hpp"

namespace qsmpc::harness {

EpisodeView::EpisodeView(const Trace& trace)
    : trace_(trace),
      model_(model_of(trace.scenario)),
      parts_(decision_parts(trace.scenario)),
      states_(true_states(trace)),
      clearances_(states_.cols()),
      residuals_(one_step_residuals(trace, *model_)) {
  const controller::UnsafeSet unsafe(trace.scenario.safe_set);
  for (Eigen::Index k = 0; k < states_.cols(); ++k) {
    clearances_[k] = controller::clearance(states_.col(k), unsafe);
  }
  summary_ = summarise(*this);
}

}  // namespace qsmpc::harness
