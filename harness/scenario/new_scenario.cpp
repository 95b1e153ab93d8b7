#include "harness/scenario/new_scenario.hpp"

#include <fmt/format.h>

#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

// Lengths in m, angles in rad, times in s.
constexpr const char* kText =
    R"(# A car at constant speed finds its way around a block. To drive it: qsmpc run THIS_FILE
# Lengths are in m, angles in rad, times in s. docs/scenario.md explains every key; keys not
# written here have their defaults ("qsmpc run" writes all of them to scenario.yaml).
name: {name}
description: A car drives around a block to its target

# What the planner believes: a name from "qsmpc list systems", and its constants.
model: {{system: dubins, speed: 1.5}}
# What is driven: a MuJoCo model, shipped or a path from this file. "qsmpc doctor THIS_FILE"
# compares it with the model. For the planner's model itself: {{kind: analytic}}
plant: {{kind: mujoco, mjcf: dubins_car.xml}}
time_step: 0.1

# States of this system: x, y, heading. A list of variances stands for a diagonal matrix.
initial_state: {{mean: [0, 0, 0], covariance: [0.001, 0.001, 0.001]}}
# Noise that is added to the state in every control period.
disturbance: {{covariance: [0.0004, 0.0004, 0.0001]}}

# The body that must stay clear of walls and obstacles; point: the state alone.
vehicle: {{footprint: from_mjcf}}
safe_set:
  bounds: {{x: [-1, 9], y: [-1, 7]}}
  obstacles:          # boxes of states; in the plane also disc, ellipse, box, polygon, half_plane
    - {{x: [3, 5], y: [1, 4]}}
    # - {{disc: {{centre: [6, 6], radius: 0.5}}}}
target: {{state: [8, 5, 0], radius: 0.5}}

# The certified probability of being unsafe at any stage of a plan is kept below this.
risk: {{plan: 0.02}}

controller:
  horizon: 12                  # periods planned ahead
  policy: closed_loop          # feedback about the plan; or open_loop
  quantisation: {{state: 30, noise: 30, compressed: 30}}   # points; or auto: as few as will do
  cost: {{state: [60, 60, 1], input: [2], terminal: [60, 60, 5]}}   # weights, diagonals

limit: {{steps: 150}}            # control periods after which the drive ends
video: {{camera: chase}}         # or top, fixed, split
)";

}  // namespace

std::string new_scenario_text(const std::string& name) {
  return fmt::format(fmt::runtime(kText), fmt::arg("name", quoted_yaml(name)));
}

}  // namespace qsmpc::harness
