#include "harness/mismatch/parameter_fit.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/example_trace.hpp"

namespace qsmpc::harness {
namespace mismatch_parameter_fit_test {

/// A cart whose two constants act differently, with a gain that nothing depends on.
Scenario cart() {
  return parse_scenario(
      "name: cart\n"
      "model:\n"
      "  states: {position: m, velocity: m/s}\n"
      "  inputs: {force: {unit: N, bounds: [-5, 5]}}\n"
      "  parameters: {mass: {value: 2, unit: kg}, drag: {value: 0, unit: N s/m}, spare: 1}\n"
      "  equations:\n"
      "    position: position + time_step * velocity\n"
      "    velocity: velocity + time_step * (force - drag * velocity + 0 * spare) / mass\n"
      "plant: {kind: analytic}\n"
      "initial_state: {mean: [0, 0], covariance: [0.01, 0.01]}\n"
      "disturbance: {covariance: [0.0001, 0.0001]}\n"
      "safe_set: {bounds: {position: [-5, 5]}}\n"
      "target: {state: [2, 0], radius: 0.1}\n"
      "controller: {horizon: 5, cost: {state: [1, 1], terminal: [1, 1]}}\n",
      {});
}

/// What a cart with these constants does in periods from various states, under various forces.
PlantPeriods periods_of(double mass, double drag, int count = 40) {
  Scenario scenario = cart();
  scenario.model.parameters.at("mass") = mass;
  scenario.model.parameters.at("drag") = drag;
  PlantPeriods periods{.states = Eigen::MatrixXd(2, count), .inputs = Eigen::MatrixXd(1, count)};
  for (int k = 0; k < count; ++k) {
    periods.states.col(k) << 0.1 * k, std::sin(k);
    periods.inputs(0, k) = std::cos(2.0 * k);
  }
  models::StateBatch ends(2, count);
  model_of(scenario)->step(models::StateBatch(periods.states), models::StateBatch(periods.inputs),
                           ends);
  periods.ends = ends;
  return periods;
}

TEST(ParameterFit, finds_the_constants_that_the_plant_has) {
  const ParameterFit fit = fit_parameters(cart(), {"mass", "drag"}, periods_of(3.5, 0.8));
  ASSERT_EQ(fit.parameters.size(), 2U);
  EXPECT_EQ(fit.parameters[0].before, 2.0);
  EXPECT_NEAR(fit.parameters[0].fitted, 3.5, 1e-6);
  EXPECT_NEAR(fit.parameters[1].fitted, 0.8, 1e-6);
  EXPECT_GT(fit.rms_before[1], 0.01);
  EXPECT_LT(fit.rms_after[1], 1e-8);
  EXPECT_LT(fit.rms_after[0], 1e-12);
}

// The first step would be to a mass of about -3800 kg, which the bicycle rejects.
TEST(ParameterFit, gets_past_constants_that_the_model_rejects) {
  const Scenario scenario = load_scenario("bicycle_obstacles");
  Scenario light = scenario;
  light.model.parameters.at("mass") = 300.0;
  constexpr int kCount = 30;
  PlantPeriods periods{.states = Eigen::MatrixXd::Zero(6, kCount),
                       .inputs = Eigen::MatrixXd::Zero(2, kCount)};
  periods.states.row(3).setConstant(8.0);
  for (int k = 0; k < kCount; ++k) periods.inputs(1, k) = 0.05 * std::sin(k);
  models::StateBatch ends(6, kCount);
  model_of(light)->step(models::StateBatch(periods.states), models::StateBatch(periods.inputs),
                        ends);
  periods.ends = ends;
  EXPECT_NEAR(fit_parameters(scenario, {"mass"}, periods).parameters.at(0).fitted, 300.0, 1e-3);
}

TEST(ParameterFit, keeps_constants_that_are_not_named) {
  const ParameterFit fit = fit_parameters(cart(), {"drag"}, periods_of(2.0, 0.8));
  EXPECT_NEAR(fit.parameters.at(0).fitted, 0.8, 1e-6);
}

// With the noise of the velocity σ / mass, an estimate of the drag from n periods deviates by about
// mass σ / (Δt √Σ v²).
TEST(ParameterFit, states_the_deviation_of_what_noise_leaves_unknown) {
  PlantPeriods periods = periods_of(2.0, 0.8, 400);
  constexpr double kNoise = 0.003;
  for (Eigen::Index k = 0; k < 400; ++k) periods.ends(1, k) += k % 2 == 0 ? kNoise : -kNoise;
  const FittedParameter drag = fit_parameters(cart(), {"drag"}, periods).parameters.at(0);
  const double expected = 2.0 * kNoise / (0.1 * periods.states.row(1).norm());
  EXPECT_NEAR(drag.deviation, expected, 0.02 * expected);
  EXPECT_NEAR(drag.fitted, 0.8, 4.0 * expected);
}

TEST(ParameterFit, refuses_what_the_periods_do_not_determine) {
  const Scenario scenario = cart();
  const PlantPeriods periods = periods_of(2.0, 0.5);
  EXPECT_THROW((void)fit_parameters(scenario, {"spare"}, periods), InputError);
  EXPECT_THROW((void)fit_parameters(scenario, {"drag", "spare"}, periods), InputError);
  EXPECT_THROW((void)fit_parameters(scenario, {"mas"}, periods), InputError);
  EXPECT_THROW((void)fit_parameters(scenario, {"mass", "mass"}, periods), InputError);
  EXPECT_THROW((void)fit_parameters(scenario, {"mass"}, PlantPeriods{}), InputError);
  // At rest and without a force nothing depends on either.
  PlantPeriods resting{.states = Eigen::MatrixXd::Zero(2, 5),
                       .inputs = Eigen::MatrixXd::Zero(1, 5),
                       .ends = Eigen::MatrixXd::Zero(2, 5)};
  EXPECT_THROW((void)fit_parameters(scenario, {"mass"}, resting), InputError);
  // Only the ratio of the two matters without a force.
  PlantPeriods coasting = periods;
  coasting.inputs.setZero();
  EXPECT_THROW((void)fit_parameters(scenario, {"mass", "drag"}, coasting), InputError);
}

TEST(PlantPeriods, are_those_that_the_plant_completed) {
  Trace trace = testing::example_trace();
  ASSERT_GE(trace.steps.size(), 3U);
  for (StepRecord& step : trace.steps) step.residual = Eigen::VectorXd::Constant(3, 0.25);
  trace.steps[1].residual.setConstant(std::numeric_limits<double>::quiet_NaN());
  PlantPeriods periods;
  periods.add(trace);
  const auto count = static_cast<Eigen::Index>(trace.steps.size()) - 1;
  ASSERT_EQ(periods.states.cols(), count);
  EXPECT_EQ(periods.states.col(1), trace.steps[2].state);
  EXPECT_EQ(periods.inputs.col(1), trace.steps[2].input);
  const StepRecord& first = trace.steps.front();
  models::StateBatch end(3, 1);
  model_of(trace.scenario)
      ->step(models::StateBatch(first.state), models::StateBatch(first.input), end);
  EXPECT_TRUE(periods.ends.col(0).isApprox(Eigen::VectorXd(end.col(0).array() + 0.25)));
  periods.add(trace);
  EXPECT_EQ(periods.ends.cols(), 2 * count);
}

}  // namespace mismatch_parameter_fit_test
}  // namespace qsmpc::harness
