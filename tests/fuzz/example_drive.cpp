#include "tests/fuzz/example_drive.hpp"

#include <algorithm>

#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::testing {

const harness::Scenario& example_drive() {
  static const harness::Scenario scenario = harness::parse_scenario(R"(
name: example
description: a car, a wall and a pedestrian
model: {system: dubins, speed: 1.5}
plant: {kind: analytic}
vehicle: {footprint: [{radius: 0.2}, {radius: 0.2, offset: [0.3, 0]}]}
time_step: 0.1
initial_state: {mean: [0, 0, 0], covariance: [0.01, 0.01, 0.01]}
disturbance: {covariance: [0.0004, 0.0004, 0.0001]}
safe_set:
  bounds: {x: [-2, 12], y: [-2, 12]}
  obstacles:
    - {x: [2, 4], y: [3, 5]}
    - {disc: {centre: [5, 1], radius: 0.3}, motion: {velocity: [0, -0.5], speed_deviation: 0.1, seen_deviation: 0.05}}
target: {state: [11, 9, 0], radius: 0.5}
risk: {plan: 0.05}
controller:
  horizon: 3
  policy: closed_loop
  quantisation: {state: 5, noise: 5, compressed: 5}
  cost: {state: [1, 1, 0.1], input: [0.1], terminal: [5, 5, 0.1]}
limit: {steps: 3}
)");
  return scenario;
}

Replacement replacement(const std::string& line) {
  const std::string text = line.substr(std::min(line.size(), line.find(' ') + 1));
  const auto arrow = text.find(" => ");
  if (arrow == std::string::npos) return {.old = text, .with = {}};
  return {.old = text.substr(0, arrow), .with = text.substr(arrow + 4)};
}

}  // namespace qsmpc::testing
