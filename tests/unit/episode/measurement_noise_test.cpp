// Episodes whose planner observes the state with noise.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace measurement_noise_test {

/// A car in the plane that circles a target throughout the episode, with coarse planning.
Scenario driving_about(const std::string& sensor, const std::vector<std::string>& more = {}) {
  const std::string text =
      "name: noisy\nmodel: {system: dubins, speed: 1.5}\nplant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [0, 0, 0], covariance: [0.01, 0.01, 0.01]}\n"
      "target: {state: [3, 2, 0], radius: 0.001}\nlimit: {steps: 30}\n"
      "controller:\n  horizon: 3\n  max_iterations: 5\n"
      "  quantisation: {state: 10, noise: 10, compressed: 10}\n"
      "  feedback_gain: [0.3, -0.2, -0.5]\n"
      "disturbance: {covariance: [0.001, 0.002, 0.0005], sensor: " +
      sensor + "}\n";
  return parse_scenario(text, {.overrides = more});
}

const std::string correlated = "[[0.04, 0.01, 0], [0.01, 0.09, -0.006], [0, -0.006, 0.0025]]";

Eigen::VectorXd error_of(const StepRecord& step) { return step.observation - step.state; }

TEST(MeasurementNoise, has_the_covariance_asked_for_and_depends_on_nothing_else) {
  const Scenario scenario = driving_about(correlated, {"limit.steps=400"});
  const Trace trace = run_episode(scenario, {.seed = 5});
  ASSERT_EQ(trace.steps.size(), 400U);
  // Whitened, the errors have covariance I and no correlation with earlier errors or disturbances.
  const Eigen::LLT<Eigen::Matrix3d> root(scenario.disturbance.sensor);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d with_last = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d with_disturbance = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d scale = scenario.disturbance.covariance.diagonal().cwiseSqrt();
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (const StepRecord& step : trace.steps) {
    const Eigen::Vector3d error = root.matrixL().solve(error_of(step));
    squares += error * error.transpose() / 400.0;
    with_last += error * last.transpose() / 400.0;
    with_disturbance += error * step.disturbance.cwiseQuotient(scale).transpose() / 400.0;
    last = error;
  }
  // An entry has standard deviation √(1/n), on the diagonal √(2/n); one seed in a thousand exceeds
  // four times that.
  const double limit = 4.0 * std::sqrt(2.0 / 400.0);
  EXPECT_LE((squares - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), limit);
  EXPECT_LE(with_last.cwiseAbs().maxCoeff(), limit);
  EXPECT_LE(with_disturbance.cwiseAbs().maxCoeff(), limit);
}

TEST(MeasurementNoise, leaves_initial_state_and_disturbances_as_they_are) {
  const Trace exact = run_episode(driving_about("[0, 0, 0]"), {.seed = 5});
  const Trace noisy = run_episode(driving_about(correlated), {.seed = 5});
  ASSERT_EQ(exact.steps.size(), noisy.steps.size());
  EXPECT_EQ(exact.steps[0].state, noisy.steps[0].state);
  EXPECT_NE(exact.steps[0].input, noisy.steps[0].input);
  for (std::size_t k = 0; k < exact.steps.size(); ++k) {
    EXPECT_EQ(exact.steps[k].disturbance, noisy.steps[k].disturbance);
  }
}

TEST(MeasurementNoise, does_not_come_from_the_seed_of_the_plant) {
  const Trace first = run_episode(driving_about(correlated), {.seed = 5, .plant_seed = 1});
  const Trace second = run_episode(driving_about(correlated), {.seed = 5, .plant_seed = 2});
  const Trace third = run_episode(driving_about(correlated), {.seed = 6, .plant_seed = 1});
  EXPECT_EQ(first.steps[0].observation, second.steps[0].observation);
  EXPECT_NE(first.steps[1].disturbance, second.steps[1].disturbance);
  // One subtraction and one addition of numbers of order 1.
  EXPECT_LE((error_of(first.steps[4]) - error_of(second.steps[4])).norm(), 1e-14);
  EXPECT_GT((error_of(first.steps[4]) - error_of(third.steps[4])).norm(), 1e-3);
}

TEST(MeasurementNoise, of_no_covariance_shows_the_state_itself) {
  const Scenario scenario = driving_about("[0, 0, 0]");
  const auto model = model_of(scenario);
  const Trace trace = run_episode(scenario, {.seed = 5});
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const StepRecord& step = trace.steps[k];
    EXPECT_EQ(step.observation, step.state);
    if (k == 0) continue;
    models::StateBatch next(3, 1);
    model->step(models::StateBatch(trace.steps[k - 1].state),
                models::StateBatch(trace.steps[k - 1].input), next);
    EXPECT_EQ(step.belief_mean, next.col(0));
    EXPECT_EQ(step.belief_covariance, scenario.disturbance.covariance);
  }
}

TEST(MeasurementNoise, is_in_the_input_by_the_gain_of_the_policy) {
  const Scenario scenario = driving_about(correlated);
  for (const StepRecord& step : run_episode(scenario, {.seed = 4}).steps) {
    const Eigen::VectorXd deviation = step.observation - step.belief_mean;
    const double wanted =
        step.plan_inputs(0, 0) + 0.3 * deviation[0] - 0.2 * deviation[1] - 0.5 * deviation[2];
    EXPECT_NEAR(step.input[0], std::clamp(wanted, -2.0, 2.0), 1e-12);  // rounding
  }
}

TEST(MeasurementNoise, is_carried_through_the_step_into_the_next_belief) {
  const Scenario scenario = driving_about(correlated);
  const auto model = model_of(scenario);
  const Trace trace = run_episode(scenario, {.seed = 4});
  for (std::size_t k = 0; k + 1 < trace.steps.size(); ++k) {
    const StepRecord& step = trace.steps[k];
    const StepRecord& next = trace.steps[k + 1];
    models::StateBatch predicted(3, 1);
    model->step(models::StateBatch(step.observation), models::StateBatch(step.input), predicted);
    EXPECT_EQ(next.belief_mean, predicted.col(0));
    const double heading = step.observation[2];
    Eigen::Matrix3d slope = Eigen::Matrix3d::Identity();
    slope(0, 2) = -0.15 * std::sin(heading);  // of 1.5 m/s for 0.1 s
    slope(1, 2) = 0.15 * std::cos(heading);
    const Eigen::Matrix3d expected =
        slope * scenario.disturbance.sensor * slope.transpose() + scenario.disturbance.covariance;
    // Products and sums of numbers below 0.1.
    EXPECT_LE((next.belief_covariance - expected).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(next.belief_covariance, next.belief_covariance.transpose());
  }
}

TEST(MeasurementNoise, does_not_move_the_plant) {
  const Scenario scenario = driving_about(correlated);
  const auto model = model_of(scenario);
  const Trace trace = run_episode(scenario, {.seed = 4});
  for (std::size_t k = 0; k + 1 < trace.steps.size(); ++k) {
    const StepRecord& step = trace.steps[k];
    models::StateBatch next(3, 1);
    model->step(models::StateBatch(step.state), models::StateBatch(step.input), next);
    // One addition: exact up to rounding of numbers of order 1.
    EXPECT_TRUE(trace.steps[k + 1].state.isApprox(next.col(0) + step.disturbance, 1e-14));
  }
}

TEST(MeasurementNoise, does_not_decide_the_outcome) {
  // So much noise that the target seems reached, and the wall crossed, long before they are.
  const Scenario scenario = driving_about(
      "[1, 1, 0]", {"target={state: [3, 0, 0], radius: 0.5}", "safe_set.bounds.y=[-1.5, 1.5]"});
  const auto distance = [&](const Eigen::VectorXd& state) {
    return (state.head(2) - scenario.target.state.head(2)).norm();
  };
  bool seen_at_the_target = false;
  bool seen_beyond_the_wall = false;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Trace trace = run_episode(scenario, {.seed = seed});
    for (const StepRecord& step : trace.steps) {
      EXPECT_GT(distance(step.state), 0.5);
      EXPECT_GT(controller::clearance(step.state, scenario.safe_set), 0.0);
      seen_at_the_target = seen_at_the_target || distance(step.observation) < 0.5;
      seen_beyond_the_wall =
          seen_beyond_the_wall || controller::clearance(step.observation, scenario.safe_set) < 0.0;
    }
    EXPECT_EQ(trace.outcome == Outcome::kReached, distance(trace.final_state) <= 0.5);
  }
  EXPECT_TRUE(seen_at_the_target);
  EXPECT_TRUE(seen_beyond_the_wall);
}

}  // namespace measurement_noise_test
}  // namespace qsmpc::harness
