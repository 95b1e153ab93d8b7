// Small campaigns and made-up rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/store/episode_row.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::testing {

/// Drives of at most three short periods with few points.
inline harness::Scenario quick_scenario(int horizon = 3) {
  return harness::parse_scenario(
      fmt::format("name: quick\n"
                  "model: {{system: dubins, speed: 1.5}}\n"
                  "plant: {{kind: analytic}}\n"
                  "vehicle: {{footprint: point}}\n"
                  "time_step: 0.1\n"
                  "initial_state: {{mean: [0, 0, 0], covariance: [0.01, 0.01, 0.01]}}\n"
                  "disturbance: {{covariance: [0.01, 0.01, 0.001]}}\n"
                  "safe_set:\n"
                  "  bounds: {{x: [-1, 12], y: [-1, 12]}}\n"
                  "  obstacles: [{{x: [0.4, 2], y: [0.3, 2]}}]\n"
                  "target: {{state: [11, 9, 0], radius: 0.5}}\n"
                  "controller:\n"
                  "  horizon: {}\n"
                  "  quantisation: {{state: 10, noise: 10, compressed: 10}}\n"
                  "  cost: {{state: [60, 60, 1], input: [2], terminal: [60, 60, 5]}}\n"
                  "  max_iterations: 5\n"
                  "limit: {{steps: 3}}\n",
                  horizon));
}

inline harness::CampaignVariant quick_variant(const std::string& name, int horizon = 3) {
  return {.name = name,
          .scenario = "quick.yaml",
          .settings = name,
          .overrides = {},
          .plant = "",
          .resolved = quick_scenario(horizon)};
}

inline harness::Campaign quick_campaign(std::int64_t seeds = 4) {
  return {.name = "quick",
          .variants = {quick_variant("three", 3), quick_variant("two", 2)},
          .seeds = {.first = 5, .count = seeds}};
}

inline harness::EpisodeRow example_row(std::int64_t variant, std::uint64_t seed,
                                       const std::string& outcome = "reached") {
  const double x = 0.1 * static_cast<double>(seed % 100) + static_cast<double>(variant);
  return {.variant = variant,
          .seed = seed,
          .outcome = outcome,
          .fault = outcome == "fault" ? "it broke" : "",
          .steps = 2,
          .time_to_target = outcome == "reached" ? std::optional(x) : std::nullopt,
          .unsafe = false,
          .min_clearance = 1.0 / (1.0 + x),
          .cost = 100.0 + x,
          .next_step_max = 1e-3,
          .next_step_sum = 2e-3,
          .horizon_max = 0.1,
          .thesis_max = 0.2,
          .believed_max = 5e-4,
          .believed_sum = 7e-4,
          .iterations_median = 7.0,
          .fallbacks = 1,
          .risk_exceeded = 1,
          .trace = "",
          .version = "1.2",
          .timing = {.finished_at = 1e9 + x, .wall_ms = 3.0, .deadline_misses = 1},
          .periods = {{.certified = 1e-3, .published = 1e-2, .unsafe = false, .ocp_ms = 1.5},
                      {.certified = 2e-3, .published = 3e-2, .unsafe = true, .ocp_ms = 0.5}}};
}

}  // namespace qsmpc::testing
