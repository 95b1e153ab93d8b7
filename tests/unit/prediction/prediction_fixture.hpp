// Small scenarios and folders for tests of predictions.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/prediction/prediction_report.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {

/// A car in a square, with few particles.
inline harness::Scenario small_scenario(const std::vector<std::string>& overrides = {}) {
  return harness::parse_scenario(
      "name: small\n"
      "model: {system: dubins, speed: 1.5}\n"
      "plant: {kind: analytic}\n"
      "vehicle: {footprint: point}\n"
      "seed: 7\n"
      "initial_state: {mean: [0, 0, 0], covariance: [0.01, 0.01, 0.01]}\n"
      "disturbance: {covariance: [0.01, 0.01, 0.001]}\n"
      "safe_set: {bounds: {x: [-0.5, 12], y: [-0.5, 12]}}\n"
      "target: {state: [11, 9, 0]}\n"
      "controller:\n"
      "  horizon: 4\n"
      "  quantisation: {state: 27, noise: 8, compressed: 30}\n"
      "  input_bounds: {yaw_rate: [-2, 2]}\n"
      "  cost: {state: [60, 60, 1], input: [2], terminal: [60, 60, 5]}\n",
      {.overrides = overrides});
}

}  // namespace qsmpc::testing
