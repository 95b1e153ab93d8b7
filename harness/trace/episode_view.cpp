#include "harness/trace/episode_view.hpp"

#include <cstddef>
#include <iterator>
#include <stdexcept>

#include "controller/regions/unsafe_set.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/trace/true_places.hpp"

namespace qsmpc::harness {
namespace {

double duration_of(const Trace& trace) {
  return trace.steps.empty() ? 0.0 : trace.steps.back().time + trace.scenario.time_step;
}

Eigen::MatrixXd residuals_of(const Trace& trace) {
  const Eigen::Index dim = std::ssize(trace.system.states);
  Eigen::MatrixXd residuals(dim, completed_periods(trace));
  for (Eigen::Index k = 0; k < residuals.cols(); ++k) {
    const Eigen::VectorXd& residual = trace.steps[static_cast<std::size_t>(k)].residual;
    if (residual.size() != dim) throw std::invalid_argument("a step has no residual");
    residuals.col(k) = residual;
  }
  return residuals;
}

}  // namespace

EpisodeView::EpisodeView(const Trace& trace)
    : trace_(trace),
      parts_(decision_parts(trace.scenario)),
      duration_(duration_of(trace)),
      clearance_unit_(clearance_unit_of(trace.scenario.safe_set, trace.system)),
      states_(true_states(trace)),
      clearances_(states_.cols()),
      residuals_(residuals_of(trace)) {
  const controller::UnsafeSet unsafe(driven_safe_set(trace));
  for (Eigen::Index k = 0; k < states_.cols(); ++k) {
    clearances_[k] = controller::clearance(states_.col(k), unsafe, k);
  }
  summary_ = summarise(*this);
}

std::optional<double> EpisodeView::first_unsafe_time() const {
  for (Eigen::Index k = 0; k < clearances_.size(); ++k) {
    if (clearances_[k] <= 0.0) return static_cast<double>(k) * scenario().time_step;
  }
  return std::nullopt;
}

}  // namespace qsmpc::harness
