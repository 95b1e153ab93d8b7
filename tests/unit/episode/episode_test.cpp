#include "harness/episode/episode.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/planning/planner.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/residuals.hpp"
#include "tests/unit/trace/trace_matchers.hpp"

namespace qsmpc::harness {
namespace episode_test {

/// The shipped default, reduced so that it can run many times.
Scenario small_scenario(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      "controller.horizon=5", "controller.quantisation={state: 20, noise: 20, compressed: 20}",
      "limit.steps=12", "plant.kind=analytic", "vehicle.footprint=point"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario("dubins_obstacles", overrides);
}

void expect_equal_steps(const StepRecord& a, const StepRecord& b) {
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.input, b.input);
  EXPECT_EQ(a.plan_inputs, b.plan_inputs);
  EXPECT_EQ(a.belief_mean, b.belief_mean);
  EXPECT_EQ(a.cost.total(), b.cost.total());
  ASSERT_EQ(a.particles.size(), b.particles.size());
  for (std::size_t k = 0; k < a.particles.size(); ++k) {
    EXPECT_EQ(a.particles[k].locations, b.particles[k].locations);
    EXPECT_EQ(a.certificates.at(k == 0 ? 0 : k - 1).value,
              b.certificates.at(k == 0 ? 0 : k - 1).value);
  }
}

TEST(Episode, points_left_to_a_tolerance_are_those_that_the_trace_says) {
  const Scenario asked = small_scenario({"controller.quantisation.tolerance=0.01"});
  const Trace chosen = run_episode(asked, {.seed = 7});
  const Scenario::Quantisation& points = chosen.scenario.controller.quantisation;
  EXPECT_EQ(points.tolerance, 0.0);
  EXPECT_LT(points.compressed, 20);
  EXPECT_EQ(points.noise, 20);
  EXPECT_EQ(chosen.scenario_text, to_yaml(chosen.scenario));
  const Trace given = run_episode(chosen.scenario, {.seed = 7});
  ASSERT_EQ(given.steps.size(), chosen.steps.size());
  for (std::size_t k = 0; k < given.steps.size(); ++k) {
    expect_equal_steps(given.steps[k], chosen.steps[k]);
  }
}

TEST(Episode, points_of_controllers_without_particles_are_left_as_they_are) {
  const Trace trace = run_episode(
      small_scenario({"controller.quantisation.tolerance=0.01", "controller.kind=nominal"}),
      {.seed = 7});
  const Scenario::Quantisation& points = trace.scenario.controller.quantisation;
  EXPECT_EQ(points.state, 20);
  EXPECT_EQ(points.compressed, 20);
}

TEST(Episode, the_same_seed_gives_the_same_trace_on_every_plant) {
  for (const char* kind : {"analytic", "mujoco"}) {
    const Scenario scenario = small_scenario({std::string("plant.kind=") + kind});
    const Trace first = run_episode(scenario, {.seed = 7});
    const Trace second = run_episode(scenario, {.seed = 7});
    ASSERT_EQ(first.steps.size(), 12U);
    ASSERT_EQ(second.steps.size(), 12U);
    for (std::size_t k = 0; k < first.steps.size(); ++k) {
      expect_equal_steps(first.steps[k], second.steps[k]);
      EXPECT_EQ(first.steps[k].disturbance, second.steps[k].disturbance);
    }
    EXPECT_EQ(first.final_state, second.final_state);
    ASSERT_EQ(first.motion.size(), second.motion.size());
    for (std::size_t k = 0; k < first.motion.size(); ++k) {
      EXPECT_EQ(first.motion[k].qpos, second.motion[k].qpos);
    }
  }
}

TEST(Episode, a_model_error_is_in_every_certificate_and_in_every_belief_that_was_predicted) {
  const Trace of_model = run_episode(small_scenario({"risk={}"}), {.seed = 7});
  const Trace of_plant = run_episode(
      small_scenario({"risk={}", "model_error={rms: [0.03, 0.04, 0.01]}"}), {.seed = 7});
  ASSERT_EQ(of_plant.steps.size(), of_model.steps.size());
  const double radius = Eigen::Vector3d(0.03, 0.04, 0.01).norm();
  for (std::size_t k = 0; k < of_plant.steps.size(); ++k) {
    const StepRecord& step = of_plant.steps[k];
    // Without risk limits, plans do not depend on the certificates.
    EXPECT_EQ(step.plan_inputs, of_model.steps[k].plan_inputs);
    EXPECT_EQ(step.budgets[0].model, k == 0 ? 0.0 : radius);
    EXPECT_GE(step.budgets[1].model, radius);
    EXPECT_GT(step.budgets.back().total, of_model.steps[k].budgets.back().total);
    EXPECT_EQ(of_model.steps[k].budgets.back().model, 0.0);
    for (std::size_t s = 0; s < step.certificates.size(); ++s) {
      EXPECT_GE(step.certificates[s].of("c1"), of_model.steps[k].certificates[s].of("c1"));
    }
  }
}

TEST(Episode, every_plan_uses_the_model_error_of_its_own_periods) {
  const Trace trace =
      run_episode(small_scenario({"model_error={rms: [0.01, 0, 0], first: [{rms: [0.3, 0, 0]}, "
                                  "{offset: [0, 0.1, 0], rms: [0, 0.1, 0]}]}"}),
                  {.seed = 7});
  const std::vector<double> radii{0.3, 0.2};
  const auto radius = [&](std::size_t period) { return period < 2 ? radii[period] : 0.01; };
  ASSERT_GE(trace.steps.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) {
    const std::vector<controller::StageBudget>& budgets = trace.steps[k].budgets;
    EXPECT_NEAR(budgets[0].model, k == 0 ? 0.0 : radius(k - 1), 1e-15) << k;
    for (std::size_t s = 0; s + 1 < budgets.size(); ++s) {
      EXPECT_NEAR(budgets[s + 1].model, budgets[s].lipschitz * budgets[s].model + radius(k + s),
                  1e-12)
          << "step " << k << ", stage " << s;
    }
  }
}

TEST(Episode, another_seed_gives_another_trace) {
  const Scenario scenario = small_scenario();
  const Trace first = run_episode(scenario, {.seed = 7});
  const Trace second = run_episode(scenario, {.seed = 8});
  EXPECT_NE(first.steps[0].state, second.steps[0].state);
  EXPECT_NE(first.steps[0].disturbance, second.steps[0].disturbance);
}

// The plan of a period is a function of the belief, and the belief one of earlier observations:
// with only the plant's disturbances changed, everything is equal until the first disturbed state
// is observed, and differs from there on.
TEST(Episode, the_planner_does_not_see_the_disturbances) {
  for (const char* kind : {"analytic", "mujoco"}) {
    const Scenario scenario = small_scenario({std::string("plant.kind=") + kind});
    const Trace first = run_episode(scenario, {.seed = 7, .plant_seed = 1});
    const Trace second = run_episode(scenario, {.seed = 7, .plant_seed = 2});
    expect_equal_steps(first.steps[0], second.steps[0]);
    EXPECT_NE(first.steps[0].disturbance, second.steps[0].disturbance);
    // Computed before the state at step 1 is observed.
    EXPECT_EQ(first.steps[1].plan_inputs, second.steps[1].plan_inputs);
    EXPECT_EQ(first.steps[1].belief_mean, second.steps[1].belief_mean);
    EXPECT_NE(first.steps[1].state, second.steps[1].state);
    EXPECT_NE(first.steps[2].plan_inputs, second.steps[2].plan_inputs);
  }
}

TEST(Episode, the_analytic_plant_moves_as_the_model_says) {
  const Scenario scenario = small_scenario();
  const Trace trace = run_episode(scenario, {.seed = 3});
  const auto model = model_of(scenario);
  for (std::size_t k = 0; k + 1 < trace.steps.size(); ++k) {
    const StepRecord& step = trace.steps[k];
    const models::StateBatch state = step.state;
    const models::StateBatch input = step.input;
    models::StateBatch next(3, 1);
    model->step(state, input, next);
    EXPECT_EQ(trace.steps[k + 1].belief_mean, next.col(0));
    // One addition: exact up to rounding of numbers of order 1.
    EXPECT_TRUE(trace.steps[k + 1].state.isApprox(next.col(0) + step.disturbance, 1e-14));
  }
}

TEST(Episode, leaves_a_whole_trace_with_what_the_model_does_not_explain) {
  const Scenario scenario = small_scenario({"plant.kind=mujoco", "limit.steps=3"});
  const Trace trace = run_episode(scenario, {.seed = 3});
  const auto model = model_of(scenario);
  testing::expect_same_system(trace.system, model->description());
  testing::expect_same_system(trace_header(scenario, 3).system, model->description());
  Trace again = trace;
  add_residuals(again, *model);
  ASSERT_EQ(trace.steps.size(), 3U);
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    EXPECT_TRUE(testing::same_bits(trace.steps[k].residual, again.steps[k].residual));
    EXPECT_FALSE(trace.steps[k].residual.isZero(1e-6));  // the plant is not the model
  }
}

TEST(Episode, inputs_stay_within_their_bounds) {
  const Scenario scenario = small_scenario({"controller.input_bounds={yaw_rate: [-0.4, 0.7]}"});
  for (const StepRecord& step : run_episode(scenario, {.seed = 1}).steps) {
    EXPECT_GE(step.input[0], -0.4);
    EXPECT_LE(step.input[0], 0.7);
    EXPECT_GE(step.plan_inputs.minCoeff(), -0.4);
    EXPECT_LE(step.plan_inputs.maxCoeff(), 0.7);
  }
}

TEST(Episode, ends_at_the_target) {
  const Scenario scenario = small_scenario({"target={state: [1, 0, 0], radius: 0.5}"});
  const Trace trace = run_episode(scenario, {.seed = 2});
  EXPECT_EQ(trace.outcome, Outcome::kReached);
  EXPECT_LE((trace.final_state.head(2) - scenario.target.state.head(2)).norm(), 0.5);
  for (const StepRecord& step : trace.steps) {
    EXPECT_GT((step.state.head(2) - scenario.target.state.head(2)).norm(), 0.5);
  }
}

// A pole that is upright after a whole turn.
TEST(Episode, a_target_angle_is_reached_whole_turns_away_where_it_is_meant_modulo_a_turn) {
  const std::string text =
      "name: pole\nmodel: {system: cart_pole}\nplant: {kind: analytic, mjcf: \"\"}\n"
      "time_step: 0.05\ninitial_state: {mean: [0, 0, 6.3, 0]}\nlimit: {steps: 1}\n"
      "controller: {horizon: 3, quantisation: {state: 10, noise: 10, compressed: 10}}\n";
  const std::string target = "target: {state: [0, 0, 0, 0], radius: 0.1, angles: [";
  EXPECT_EQ(run_episode(parse_scenario(text + target + "]}\n"), {}).outcome, Outcome::kTimeout);
  EXPECT_EQ(run_episode(parse_scenario(text + target + "pole_angle]}\n"), {}).outcome,
            Outcome::kReached);
}

TEST(Episode, times_out_after_its_limit) {
  const Trace trace = run_episode(small_scenario({"limit.steps=3"}), {.seed = 2});
  EXPECT_EQ(trace.outcome, Outcome::kTimeout);
  EXPECT_EQ(trace.steps.size(), 3U);
}

TEST(Episode, an_interrupt_keeps_what_was_driven) {
  int asked = 0;
  EpisodeOptions options{.seed = 2};
  options.should_stop = [&asked] { return ++asked > 4; };
  const Trace trace = run_episode(small_scenario(), options);
  EXPECT_EQ(trace.outcome, Outcome::kInterrupted);
  EXPECT_EQ(trace.steps.size(), 4U);
  EXPECT_EQ(trace.final_state.size(), 3);
}

TEST(Episode, an_open_loop_policy_ignores_the_measured_state) {
  const Scenario scenario = small_scenario({"controller.policy=open_loop"});
  for (const StepRecord& step : run_episode(scenario, {.seed = 4}).steps) {
    EXPECT_EQ(step.input, step.plan_inputs.col(0));
  }
}

TEST(Episode, a_given_gain_steers_by_the_deviation) {
  const Scenario scenario = small_scenario({"controller.feedback_gain=[[0.3, -0.2, -0.5]]"});
  for (const StepRecord& step : run_episode(scenario, {.seed = 4}).steps) {
    const Eigen::VectorXd deviation = step.state - step.belief_mean;
    const double wanted =
        step.plan_inputs(0, 0) + 0.3 * deviation[0] - 0.2 * deviation[1] - 0.5 * deviation[2];
    EXPECT_NEAR(step.input[0], std::clamp(wanted, -2.0, 2.0), 1e-12);  // rounding
  }
}

TEST(Episode, leaving_the_noise_out_of_the_prediction_keeps_the_belief_only) {
  const Trace trace =
      run_episode(small_scenario({"controller.propagate_noise=false", "limit.steps=2"}), {});
  for (const StageParticles& stage : trace.steps[0].particles) {
    EXPECT_EQ(stage.weights, trace.steps[0].particles[0].weights);
  }
}

// Compression loses covariance at every step, moment matching does not.
TEST(Episode, a_chosen_propagator_and_quantiser_are_what_it_is_predicted_with) {
  const auto plan_of = [](const std::string& propagator, const std::string& quantiser) {
    const Trace trace =
        run_episode(small_scenario({"limit.steps=2", "controller.propagator=" + propagator,
                                    "controller.quantisation.quantiser=" + quantiser}),
                    {.seed = 6});
    EXPECT_EQ(trace.steps.size(), 2U);
    return trace.steps.front();
  };
  const auto last_variance = [](const StepRecord& step) {
    return controller::covariance_of(step.particles.back()).trace();
  };
  const StepRecord usual = plan_of("compressed", "product");
  const StepRecord chosen = plan_of("moment_matched", "lloyd");
  EXPECT_LT(chosen.budgets[0].total, usual.budgets[0].total);
  EXPECT_GT(last_variance(chosen), 1.05 * last_variance(usual));
  // Each key by itself as well.
  EXPECT_EQ(plan_of("compressed", "lloyd").budgets[0].total, chosen.budgets[0].total);
  EXPECT_GT(last_variance(plan_of("moment_matched", "product")), 1.05 * last_variance(usual));
}

TEST(Episode, controller_keys_of_the_scenario_reach_the_planner) {
  const controller::PlannerSettings usual = planner_settings(small_scenario());
  EXPECT_FALSE(usual.optimise_gain);
  EXPECT_EQ(usual.solver, "lbfgs");
  EXPECT_EQ(usual.input_bounding, "bounded");
  EXPECT_EQ(usual.propagator, "mixture");
  EXPECT_EQ(usual.deadline, std::numeric_limits<double>::infinity());
  const controller::PlannerSettings chosen = planner_settings(
      small_scenario({"controller.optimise_gain=true", "controller.input_bounding=tanh",
                      "controller.propagator=soft", "controller.deadline=0.02"}));
  EXPECT_TRUE(chosen.optimise_gain);
  EXPECT_EQ(chosen.input_bounding, "tanh");
  EXPECT_EQ(chosen.propagator, "soft");
  EXPECT_EQ(chosen.deadline, 0.02);
  EXPECT_EQ(planner_settings(small_scenario({"controller.solver=slsqp"})).solver, "slsqp");
  EXPECT_TRUE(usual.cost.angles.empty());
  EXPECT_EQ(planner_settings(small_scenario({"target.angles=[heading]"})).cost.angles,
            std::vector<int>{2});
  EXPECT_EQ(planner_settings(small_scenario({"controller.propagate_noise=false"})).propagator,
            "noise_free");
}

TEST(Episode, every_solver_and_bounding_drives_within_the_bounds) {
  std::vector<std::string> choices = {"controller.optimise_gain=true"};
  for (const controller::SolverEntry& entry : controller::solvers())
    choices.push_back("controller.solver=" + entry.name);
  for (const controller::InputBoundingEntry& entry : controller::input_boundings()) {
    choices.push_back("controller.input_bounding=" + entry.name);
  }
  for (const std::string& choice : choices) {
    SCOPED_TRACE(choice);
    const Trace trace = run_episode(
        small_scenario({choice, "controller.input_bounds={yaw_rate: [-0.4, 0.7]}"}), {.seed = 1});
    EXPECT_EQ(trace.steps.size(), 12U);
    for (const StepRecord& step : trace.steps) {
      EXPECT_FALSE(step.fallback);
      EXPECT_NE(step.solver_status, "numerical_trouble");
      EXPECT_GE(step.plan_inputs.minCoeff(), -0.4);
      EXPECT_LE(step.plan_inputs.maxCoeff(), 0.7);
      EXPECT_GE(step.input[0], -0.4);
      EXPECT_LE(step.input[0], 0.7);
    }
  }
}

// Planning before the loop, which keeps its first periods fast, must not affect its results.
TEST(Episode, the_first_plan_is_that_of_a_planner_that_has_not_planned_before) {
  const Scenario scenario = small_scenario();
  const Trace trace = run_episode(scenario, {.seed = 3});
  const auto model = model_of(scenario);
  controller::Planner planner(*model, planner_settings(scenario));
  const controller::Plan& plan = planner.plan(
      {.mean = scenario.initial_state.mean, .covariance = scenario.initial_state.covariance});
  EXPECT_FALSE(plan.warm);
  EXPECT_EQ(trace.steps[0].plan_inputs, plan.policy.inputs);
  EXPECT_EQ(trace.steps[0].iterations, plan.evaluations);
  EXPECT_EQ(trace.steps[0].cost.total(), plan.cost.total());
}

// Loops over more than 1024 particles are split.
TEST(Episode, the_number_of_threads_changes_nothing) {
  const auto drive = [](int threads) {
    return run_episode(
        small_scenario({"controller.quantisation={state: 3000, noise: 8, compressed: 3000}",
                        "controller.horizon=2", "controller.max_iterations=5", "limit.steps=2",
                        "controller.threads=" + std::to_string(threads)}),
        {.seed = 4});
  };
  const Trace first = drive(1);
  const Trace second = drive(2);
  ASSERT_EQ(first.steps.size(), 2U);
  ASSERT_EQ(second.steps.size(), 2U);
  EXPECT_GT(first.steps[0].particles[0].weights.size(), 2048);
  EXPECT_GT(first.steps[0].particles[1].weights.size(), 2048);
  for (std::size_t k = 0; k < first.steps.size(); ++k) {
    expect_equal_steps(first.steps[k], second.steps[k]);
  }
  EXPECT_EQ(first.final_state, second.final_state);
}

TEST(Episode, drives_on_when_no_plan_is_done_in_time) {
  const Trace trace = run_episode(small_scenario({"controller.deadline=1e-9"}), {.seed = 2});
  EXPECT_EQ(trace.outcome, Outcome::kTimeout);
  ASSERT_EQ(trace.steps.size(), 12U);
  for (const StepRecord& step : trace.steps) {
    EXPECT_EQ(step.solver_status, "deadline");
    EXPECT_TRUE(step.plan_inputs.allFinite());
    EXPECT_EQ(step.certificates.size(), 5U);
  }
  EXPECT_EQ(EpisodeView(trace).summary().deadline_stops, 12);
  const Trace in_time = run_episode(small_scenario(), {.seed = 2});
  EXPECT_EQ(EpisodeView(in_time).summary().deadline_stops, 0);
}

// Reports and videos are made from the trace, so every stage must be present and consistent.
TEST(Episode, records_every_stage) {
  const Trace trace = run_episode(small_scenario(), {.seed = 5});
  for (const StepRecord& step : trace.steps) {
    ASSERT_EQ(step.particles.size(), 6U);
    ASSERT_EQ(step.budgets.size(), 6U);
    ASSERT_EQ(step.certificates.size(), 5U);
    EXPECT_EQ(step.plan_states.cols(), 6);
    for (const StageParticles& stage : step.particles) {
      EXPECT_NEAR(stage.weights.sum(), 1.0, 1e-12);  // rounding of at most 400 terms
      EXPECT_GE(stage.weights.minCoeff(), 0.0);
    }
    for (const controller::StageCertificate& certificate : step.certificates) {
      EXPECT_EQ(certificate.value, std::min({certificate.of("c1"), certificate.of("c2"),
                                             certificate.of("c3"), certificate.of("c4")}));
      EXPECT_GE(certificate.value, 0.0);
      EXPECT_LE(certificate.value, 1.0);
    }
  }
}

}  // namespace episode_test
}  // namespace qsmpc::harness
