// Made-up traces with the shapes of real ones, identical on every call, for tests of trace readers.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/trace.hpp"
#include "tests/support/described_trace.hpp"

namespace qsmpc::testing {

struct ExampleTraceOptions {
  int steps = 6;
  int horizon = 3;
  int points = 8;  ///< of the fullest stage
  std::string name = "example";
};

/// Numbers in (-1, 1) that depend only on how many were drawn before.
class ExampleNoise {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1.0p-52 - 1.0;
  }

 private:
  std::uint64_t state_ = 42;
};

/// A text as a double-quoted YAML string, with escapes.
inline std::string yaml_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

inline std::string example_scenario(const ExampleTraceOptions& options) {
  return "name: " + yaml_quoted(options.name) +
         "\n"
         "description: " +
         yaml_quoted("made up for tests: " + options.name) +
         "\n"
         "model: {system: dubins, speed: 1.5}\n"
         "plant: {kind: analytic}\n"
         "vehicle: {footprint: point}\n"
         "time_step: 0.1\n"
         "initial_state: {mean: [0, 0, 0], covariance: [0.01, 0.01, 0.01]}\n"
         "disturbance: {covariance: [0.01, 0.01, 0.001]}\n"
         "safe_set:\n"
         "  bounds: {x: [-1, 12], y: [-1, 12]}\n"
         "  obstacles: [{x: [2, 4], y: [3, 5]}, {x: [6, 8], y: [5, 6.5]}]\n"
         "target: {state: [11, 9, 0], radius: 0.5}\n"
         "controller:\n"
         "  horizon: " +
         std::to_string(options.horizon) +
         "\n"
         "  cost: {state: [60, 60, 1], input: [2], terminal: [60, 60, 5]}\n";
}

inline harness::StageParticles example_particles(const Eigen::VectorXd& centre, double spread,
                                                 int points, ExampleNoise& noise) {
  harness::StageParticles stage{.locations = models::StateBatch(centre.size(), points),
                                .weights = Eigen::VectorXd(points)};
  for (Eigen::Index i = 0; i < points; ++i) {
    for (Eigen::Index d = 0; d < centre.size(); ++d) {
      stage.locations(d, i) = centre[d] + spread * noise() * (1.0 + noise());
    }
    stage.weights[i] = 1.5 + noise();
  }
  stage.weights /= stage.weights.sum();
  return stage;
}

inline void add_example_plan(harness::StepRecord& step, const harness::Scenario& scenario,
                             const ExampleTraceOptions& options, ExampleNoise& noise) {
  const auto dynamics =
      models::make_dynamics(scenario.model.system, scenario.model.parameters, scenario.time_step);
  const Eigen::Index horizon = scenario.controller.horizon;
  step.plan_inputs = Eigen::MatrixXd::Constant(1, horizon, step.input[0]);
  step.plan_states = Eigen::MatrixXd(3, horizon + 1);
  models::StateBatch state = step.state;
  for (Eigen::Index s = 0; s <= horizon; ++s) {
    step.plan_states.col(s) = state.col(0);
    // Stages differ in size, as they do after a compression.
    const int points = options.points - static_cast<int>(s) % 2;
    const double spread = 0.1 + 0.05 * static_cast<double>(s);
    step.particles.push_back(example_particles(state.col(0), spread, points, noise));
    const double bound = 0.02 * static_cast<double>(s);
    step.budgets.push_back({.belief = bound,
                            .noise = bound / 2,
                            .compression = bound / 4,
                            .model = bound / 16,
                            .dynamics = bound / 8,
                            .total = bound * 1.2,
                            .lipschitz = 1.0 + bound});
    if (s > 0) {
      // All entries differ, so a transposed copy would show.
      step.plan_gains.emplace_back(noise() * Eigen::RowVector3d(1.0, -2.0, 3.0));
      const double value = std::exp(-9.0 + static_cast<double>(s) + 2.0 * noise());
      step.certificates.push_back(
          {.value = value,
           .kind = value < 1e-3 ? "c2" : "c1",
           .figures = {value * 1.5, value, value * 2.5, value * 2.25, 1.0, value * 0.3, 0.0}});
    }
    models::StateBatch next(3, 1);
    const models::StateBatch input = step.input;
    dynamics->step(state, input, next);
    state = next;
  }
}

inline harness::StepRecord example_step(const harness::Scenario& scenario,
                                        const Eigen::VectorXd& state, int k,
                                        const ExampleTraceOptions& options, ExampleNoise& noise) {
  harness::StepRecord step;
  step.time = k * scenario.time_step;
  step.state = state;
  step.observation = state + Eigen::Vector3d(0.01, -0.02, 0.03);
  const Eigen::VectorXd way = scenario.target.state - state;
  const double error = std::atan2(way[1], way[0]) - state[2];
  step.input = Eigen::VectorXd::Constant(1, std::fmin(1.0, std::fmax(-1.0, 2.0 * error)));
  step.disturbance = Eigen::Vector3d(0.05 * noise(), 0.05 * noise(), 0.02 * noise());
  step.belief_mean = state;
  step.belief_covariance = 0.01 * Eigen::Matrix3d::Identity();
  step.belief_covariance(0, 1) = 0.001;  // not symmetric: a transposed copy would show
  step.cost = {
      {"state", 900.0 - k}, {"input", 2.0}, {"terminal", 300.0}, {"box", 0.5}, {"obstacle", 40.0}};
  step.solver_status = k % 7 == 3 ? "iteration_limit" : "converged";
  step.fallback = k % 17 == 5;
  step.iterations = 20 + k % 5;
  step.believed = 1e-4 * k;
  step.timing = {.quantise = 1.0,
                 .propagate = 2.0,
                 .optimise = 30.0 + 20.0 * noise(),
                 .certify = 3.0,
                 .total = 0.0,
                 .simulate = 4.0};
  step.timing.total =
      step.timing.quantise + step.timing.propagate + step.timing.optimise + step.timing.certify;
  add_example_plan(step, scenario, options, noise);
  return step;
}

/// A drive of a Dubins car towards the target, with `options.steps` steps and two motion samples
/// per step; the plant turns slightly less than the model predicts.
inline harness::Trace example_trace(const ExampleTraceOptions& options = {}) {
  harness::Trace trace;
  trace.scenario = harness::parse_scenario(example_scenario(options));
  trace.scenario_text = harness::to_yaml(trace.scenario);
  trace.scenario = harness::parse_scenario(trace.scenario_text);
  trace.seed = 0xFEDCBA9876543210ULL;
  trace.version = "1.2.3";
  const auto dynamics = models::make_dynamics("dubins", trace.scenario.model.parameters, 0.1);
  ExampleNoise noise;
  Eigen::VectorXd state = trace.scenario.initial_state.mean;
  trace.motion.push_back({.time = 0.0, .qpos = {state[0], state[1], 0.1, state[2]}});
  for (int k = 0; k < options.steps; ++k) {
    harness::StepRecord step = example_step(trace.scenario, state, k, options, noise);
    models::StateBatch next(3, 1);
    const models::StateBatch from = state;
    const models::StateBatch input = 0.95 * step.input;
    dynamics->step(from, input, next);
    state = next.col(0) + step.disturbance;
    for (const double part : {0.5, 1.0}) {
      trace.motion.push_back(
          {.time = step.time + 0.1 * part, .qpos = {state[0], state[1], 0.1, state[2]}});
    }
    trace.steps.push_back(std::move(step));
  }
  trace.final_state = state;
  trace.outcome = harness::Outcome::kReached;
  return described(std::move(trace));
}

}  // namespace qsmpc::testing
