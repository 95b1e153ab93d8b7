#include "harness/trace/residuals.hpp"

#include <memory>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace residuals_test {

/// A unit mass that moves as the model does in a period and is then off by `bias`.
Trace biased_trace(const models::Dynamics& model, const Eigen::Vector2d& bias, int steps) {
  Trace trace;
  Eigen::VectorXd state = Eigen::Vector2d(0.5, -1.0);
  for (int k = 0; k < steps; ++k) {
    StepRecord step;
    step.state = state;
    step.input = Eigen::VectorXd::Constant(1, 0.1 * k);
    step.disturbance = Eigen::Vector2d(0.01 * k, -0.03);
    models::StateBatch next(2, 1);
    model.step(models::StateBatch(step.state), models::StateBatch(step.input), next);
    state = next.col(0) + step.disturbance + bias;
    trace.steps.push_back(step);
  }
  trace.final_state = state;
  return trace;
}

bool is_known(const StepRecord& step) { return step.residual.allFinite(); }

TEST(OneStepResiduals, are_what_the_plant_adds_to_model_and_disturbance) {
  const auto model = models::make_dynamics("double_integrator", {}, 0.1);
  const Eigen::Vector2d bias(0.02, -0.003);
  Trace trace = biased_trace(*model, bias, 5);
  add_residuals(trace, *model);
  // Rounding of states of size 1.
  for (const StepRecord& step : trace.steps) EXPECT_TRUE(step.residual.isApprox(bias, 1e-12));
}

TEST(OneStepResiduals, of_the_period_that_broke_and_of_one_without_an_end_are_no_numbers) {
  const auto model = models::make_dynamics("double_integrator", {}, 0.1);
  Trace trace = biased_trace(*model, Eigen::Vector2d::Zero(), 3);
  const auto last_is_known = [&] {
    add_residuals(trace, *model);
    EXPECT_TRUE(is_known(trace.steps[1]));
    EXPECT_EQ(trace.steps[2].residual.size(), 2);
    return is_known(trace.steps[2]);
  };
  EXPECT_EQ(true_states(trace).cols(), 4);
  EXPECT_TRUE(last_is_known());
  trace.outcome = Outcome::kFault;
  EXPECT_FALSE(last_is_known());
  EXPECT_EQ(completed_periods(trace), 2);
  trace.outcome = Outcome::kInterrupted;
  trace.final_state.resize(0);
  EXPECT_FALSE(last_is_known());
  EXPECT_EQ(completed_periods(trace), 2);
  EXPECT_EQ(true_states(trace).cols(), 3);
}

}  // namespace residuals_test
}  // namespace qsmpc::harness
