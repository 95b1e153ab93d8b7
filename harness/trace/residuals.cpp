#include "harness/trace/residuals.hpp"

#include <cstddef>
#include <iterator>
#include <limits>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

// x⁺ − w − f(x, u) with x⁺ = f(x, u) + w rounds three times, by half a unit in the last place each;
// the rest is a margin.
constexpr double kRoundings = 4.0;

}  // namespace

Eigen::VectorXd one_step_residual(const models::Dynamics& model, const StepRecord& step,
                                  const Eigen::VectorXd& next_state) {
  const models::StateBatch state = step.state;
  const models::StateBatch input = step.input;
  models::StateBatch predicted(model.state_dim(), 1);
  model.step(state, input, predicted);
  return next_state - step.disturbance - predicted.col(0);
}

Eigen::VectorXd unknown_residual(Eigen::Index state_dim) {
  return Eigen::VectorXd::Constant(state_dim, kNotANumber);
}

Eigen::VectorXd residual_rounding(const Eigen::VectorXd& magnitude) {
  return kRoundings * std::numeric_limits<double>::epsilon() * magnitude;
}

void add_residuals(Trace& trace, const models::Dynamics& model) {
  const Eigen::MatrixXd states = true_states(trace);
  const Eigen::Index periods = completed_periods(trace);
  for (Eigen::Index k = 0; k < std::ssize(trace.steps); ++k) {
    StepRecord& step = trace.steps[static_cast<std::size_t>(k)];
    step.residual = k < periods ? one_step_residual(model, step, states.col(k + 1))
                                : unknown_residual(model.state_dim());
  }
}

}  // namespace qsmpc::harness
