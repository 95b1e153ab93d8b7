// Scenarios and plants for the tests of comparisons.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "controller/planning/planner.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/mismatch/path_ensemble.hpp"
#include "harness/mismatch/plant_pool.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::testing {

/// A car that reaches its target soon, with few particles.
inline harness::Scenario short_scenario(const std::vector<std::string>& overrides = {}) {
  return harness::parse_scenario(
      "name: short\n"
      "model: {system: dubins, speed: 1.5}\n"
      "plant: {kind: analytic, mjcf: dubins_car.xml}\n"
      "vehicle: {footprint: point}\n"
      "seed: 5\n"
      "initial_state: {mean: [0, 0, 0.5], covariance: [0.01, 0.01, 0.01]}\n"
      "disturbance: {covariance: [0.01, 0.01, 0.001]}\n"
      "safe_set: {bounds: {x: [-1, 6], y: [-0.6, 3]}}\n"
      "target: {state: [1.5, 0.5, 0], radius: 0.5}\n"
      "controller:\n"
      "  horizon: 3\n"
      "  quantisation: {state: 27, noise: 8, compressed: 30}\n"
      "  input_bounds: {yaw_rate: [-2, 2]}\n"
      "  cost: {state: [60, 60, 1], input: [2], terminal: [60, 60, 5]}\n"
      "limit: {steps: 30}\n",
      {.overrides = overrides});
}

/// Moves as the wrapped plant, then is off by `bias`; breaks where x exceeds `breaks_at`.
class AlteredPlant final : public harness::Plant {
 public:
  AlteredPlant(std::unique_ptr<harness::Plant> plant, Eigen::VectorXd bias, double breaks_at)
      : plant_(std::move(plant)), bias_(std::move(bias)), breaks_at_(breaks_at) {}

  harness::MotionSample reset(const Eigen::VectorXd& state) override {
    return plant_->reset(state);
  }

  harness::PlantStep advance(const Eigen::VectorXd& input,
                             const Eigen::VectorXd& disturbance) override {
    harness::PlantStep step = plant_->advance(input, disturbance + bias_);
    if (step.state[0] > breaks_at_) step.fault = "beyond the edge";
    return step;
  }

  [[nodiscard]] Eigen::VectorXd state() const override { return plant_->state(); }

 private:
  std::unique_ptr<harness::Plant> plant_;
  Eigen::VectorXd bias_;
  double breaks_at_;
};

/// The scenario's plant, altered.
inline harness::PlantPool altered_plants(const harness::Scenario& scenario,
                                         const Eigen::VectorXd& bias, double breaks_at = 1e9) {
  return harness::PlantPool(
      [scenario, bias, breaks_at](std::int64_t) -> std::unique_ptr<harness::Plant> {
        return std::make_unique<AlteredPlant>(harness::make_plant(scenario), bias, breaks_at);
      });
}

/// A plan of a scenario, and paths under its policy.
struct Planned {
  explicit Planned(const harness::Scenario& planned_scenario) : scenario(planned_scenario) {
    model = harness::model_of(scenario);
    belief = {.mean = scenario.initial_state.mean, .covariance = scenario.initial_state.covariance};
    controller::Planner planner(*model, harness::planner_settings(scenario));
    const controller::Plan& plan = planner.plan(belief);
    policy = plan.policy;
    particles = plan.prediction.stages;
  }

  [[nodiscard]] harness::PathSource source(std::uint64_t first = 0) const {
    return {policy, belief, scenario.disturbance.covariance, {.seed = 5, .first = first}};
  }

  harness::Scenario scenario;
  std::unique_ptr<const models::Dynamics> model;
  controller::Gaussian belief;
  controller::Policy policy;
  std::vector<controller::DiscreteMeasure> particles;
};

}  // namespace qsmpc::testing
