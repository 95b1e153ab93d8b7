// Recovery of a planner whose model gives non-finite values for a belief.
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_recovery_test {

using namespace testing;

std::unique_ptr<const models::Dynamics> bicycle() {
  return models::make_dynamics("bicycle", {}, 0.1);
}

PlannerSettings bicycle_settings(const models::Dynamics& car) {
  PlannerSettings settings;
  settings.horizon = 5;
  settings.state_points = 64;
  settings.noise_points = 20;
  settings.compressed_points = 30;
  settings.noise_covariance = 1e-3 * Eigen::MatrixXd::Identity(6, 6);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(6);
  weights.head<2>().setConstant(1.0);
  settings.cost = {.state = weights.asDiagonal(),
                   .input = 0.1 * Eigen::MatrixXd::Identity(2, 2),
                   .terminal = weights.asDiagonal(),
                   .target = Eigen::VectorXd::Zero(6)};
  settings.cost.target.head<2>() << 20.0, 3.0;
  settings.safe_set = unbounded_safe_set(6);
  settings.bounds = {.lower = car.description().input_lower,
                     .upper = car.description().input_upper};
  return settings;
}

Gaussian bicycle_belief() {
  Gaussian belief{.mean = Eigen::VectorXd::Zero(6),
                  .covariance = 0.002 * Eigen::MatrixXd::Identity(6, 6)};
  belief.mean[3] = 10.0;  // m/s
  return belief;
}

void expect_same_plan(const Plan& one, const Plan& other) {
  EXPECT_EQ(one.policy.inputs, other.policy.inputs);
  EXPECT_EQ(one.policy.gains, other.policy.gains);
  EXPECT_EQ(one.gain_change, other.gain_change);
  EXPECT_EQ(one.cost.total(), other.cost.total());
  EXPECT_EQ(one.evaluations, other.evaluations);
  EXPECT_EQ(one.status, other.status);
  EXPECT_EQ(one.prediction.stages.back().locations, other.prediction.stages.back().locations);
}

/// Plans, encounters `bad`, and plans again.
void expect_cold_start_after(const models::Dynamics& car, const PlannerSettings& settings,
                             const Gaussian& good, const Gaussian& bad) {
  Planner planner(car, settings);
  Gaussian moved = good;
  for (int step = 0; step < 3; ++step) moved.mean = planner.plan(moved).policy.states.col(1);
  const Plan& lost = planner.plan(bad);
  EXPECT_TRUE(lost.fallback || lost.status == SolverStatus::kNumericalTrouble);
  EXPECT_TRUE(lost.policy.inputs.allFinite());
  const Plan& again = planner.plan(moved);
  EXPECT_FALSE(again.warm);
  EXPECT_FALSE(again.fallback);
  EXPECT_TRUE(std::isfinite(again.cost.total()));
  Planner fresh(car, settings);
  expect_same_plan(again, fresh.plan(moved));
  // And for later plans as well.
  Gaussian next = moved;
  next.mean = again.policy.states.col(1);
  const Plan& warm = planner.plan(next);
  const Plan& expected = fresh.plan(next);
  EXPECT_EQ(warm.warm, expected.warm);
  expect_same_plan(warm, expected);
}

TEST(PlannerRecovery, enormous_beliefs_are_followed_by_a_cold_start) {
  const auto car = dubins_car();
  for (const char* propagator : {"mixture", "compressed", "noise_free"}) {
    for (const bool optimise_gain : {false, true}) {
      SCOPED_TRACE(std::string(propagator) + (optimise_gain ? ", gain" : ""));
      PlannerSettings settings = dubins_settings();
      settings.propagator = propagator;
      settings.optimise_gain = optimise_gain;
      Gaussian far = dubins_belief();
      far.mean[0] = 1e300;
      expect_cold_start_after(*car, settings, dubins_belief(), far);
    }
  }
}

TEST(PlannerRecovery, slsqp_too_starts_cold_after_an_enormous_belief) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.solver = "slsqp";
  Gaussian far = dubins_belief();
  far.mean[1] = 1e300;
  expect_cold_start_after(*car, settings, dubins_belief(), far);
}

TEST(PlannerRecovery, a_bicycle_far_beyond_the_speeds_of_its_model_is_followed_by_a_cold_start) {
  const auto car = bicycle();
  for (const char* propagator : {"mixture", "noise_free"}) {
    PlannerSettings settings = bicycle_settings(*car);
    settings.propagator = propagator;
    Gaussian fast = bicycle_belief();
    fast.mean[3] = 1e200;
    expect_cold_start_after(*car, settings, bicycle_belief(), fast);
  }
}

TEST(PlannerRecovery, a_bicycle_at_its_pole_throws_nothing) {
  const auto car = bicycle();
  for (const char* propagator : {"mixture", "noise_free"}) {
    PlannerSettings settings = bicycle_settings(*car);
    settings.propagator = propagator;
    Planner planner(*car, settings);
    Gaussian belief = bicycle_belief();
    (void)planner.plan(belief);
    // mv + S = 0, see bicycle.hpp: mass, and stiffnesses times the period.
    belief.mean[3] = -0.1 * (128916.0 + 85944.0) / 1412.0;
    Eigen::MatrixXd inputs;
    EXPECT_NO_THROW(inputs = planner.plan(belief).policy.inputs) << propagator;
    EXPECT_TRUE(inputs.allFinite()) << propagator;
    belief.covariance.setZero();
    belief.mean[5] = 1.0;
    EXPECT_NO_THROW(inputs = planner.plan(belief).policy.inputs) << propagator;
    EXPECT_TRUE(inputs.allFinite()) << propagator;
    const Plan& again = planner.plan(bicycle_belief());
    EXPECT_TRUE(std::isfinite(again.cost.total())) << propagator;
    EXPECT_FALSE(again.fallback) << propagator;
  }
}

}  // namespace planner_recovery_test
}  // namespace qsmpc::controller
