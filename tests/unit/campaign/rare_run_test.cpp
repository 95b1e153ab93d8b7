#include "harness/campaign/rare/rare_run.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/control/controller_object.hpp"
#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {
namespace rare_run_test {

using ::testing::HasSubstr;

bool never() { return false; }

/// No certificates: they take longer than everything else.
const RareSettings kBare{.splitting = {.particles = 20}, .certify = false};

/// A point that is held at 0 and rarely leaves [-limit, limit].
Scenario held_point(const std::string& limit, const std::vector<std::string>& more = {}) {
  return parse_scenario(
      "name: held\nmodel: {system: double_integrator}\nplant: {kind: analytic}\n"
      "time_step: 0.1\ninitial_state: {mean: [0.2, 0]}\n"
      "disturbance: {covariance: [0.001, 0.001]}\nvehicle: {footprint: point}\n"
      "safe_set: {bounds: {position: [-" +
          limit + ", " + limit +
          "]}}\n"
          "target: {state: [0, 0], radius: 1e-6}\n"
          "controller: {kind: lqr, cost: {state: [30, 5], input: [20], terminal: "
          "[40, 10]}}\nlimit: {steps: 10}\n",
      {.overrides = more});
}

TEST(RareRun, says_the_same_for_the_same_seed) {
  const Scenario scenario = held_point("0.42");
  const RareSettings settings{.splitting = {.particles = 10}};
  const auto one = rare_run(scenario, settings, 3, never);
  EXPECT_EQ(one, rare_run(scenario, settings, 3, never));
  EXPECT_NE(one, rare_run(scenario, settings, 4, never));
}

TEST(RareRun, counts_as_plain_drives_do_where_the_event_is_common) {
  const Scenario scenario = held_point("0.35");
  double sum = 0.0;
  std::int64_t unsafe = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RareRow row = rare_run(scenario, kBare, seed, never).value();
    sum += row.probability;
    unsafe += row.plain_unsafe;
    EXPECT_DOUBLE_EQ(row.collision + row.left_bounds, row.probability);
  }
  const double share = static_cast<double>(unsafe) / 400.0;
  // Both have a standard error of at most 0.025.
  EXPECT_NEAR(sum / 20.0, share, 0.1);
}

TEST(RareRun, finds_drives_that_are_unsafe_when_they_are_driven_again_alone) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"limit.stop_when_unsafe=false"}}) {
    const Scenario scenario = held_point("0.42", more);
    const RareRow row = rare_run(scenario, kBare, 3, never).value();
    ASSERT_FALSE(row.found.empty());
    for (const RareDrive& found : row.found) {
      const Scenario alone = parse_scenario(to_yaml(with_seeds(scenario, found.seeds)));
      const Trace trace = run_episode(alone, {.seed = alone.seed});
      EXPECT_EQ(outcome_name(trace.outcome), found.outcome);
      EXPECT_EQ(found.outcome, "left_bounds");
      const EpisodeView view(trace);
      EXPECT_TRUE(view.ended_unsafe(found.periods - 1));
      for (Eigen::Index k = 0; k + 1 < found.periods; ++k) EXPECT_FALSE(view.ended_unsafe(k));
    }
  }
}

TEST(RareRun, estimates_what_is_certified_of_a_drive) {
  const Scenario scenario = held_point("0.35");
  double plain = 0.0;
  double split = 0.0;
  constexpr std::uint64_t kRuns = 10;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    split += rare_run(scenario, {.splitting = {.particles = 10}}, seed, never).value().certified;
    for (const StepRecord& step : run_episode(scenario, {.seed = seed}).steps) {
      plain += step.certificates.front().value;
    }
  }
  EXPECT_GT(split, 0.0);
  // Neither sum of ten is accurate.
  EXPECT_LT(split, 5.0 * plain);
  EXPECT_GT(split, 0.2 * plain);
}

TEST(RareRun, says_the_same_without_certificates) {
  const Scenario scenario = held_point("0.4");
  const RareRow with = rare_run(scenario, {.splitting = {.particles = 10}}, 3, never).value();
  RareRow without =
      rare_run(scenario, {.splitting = {.particles = 10}, .certify = false}, 3, never).value();
  EXPECT_TRUE(std::isnan(without.certified));
  without.certified = with.certified;
  EXPECT_EQ(with, without);
}

TEST(RareRun, stops_within_a_period_when_interrupted) {
  int asked = 0;
  const auto row = rare_run(held_point("0.6"), {.splitting = {.particles = 20}}, 3,
                            [&] { return ++asked > 25; });
  EXPECT_FALSE(row.has_value());
  EXPECT_EQ(asked, 26);
}

TEST(RareRun, ends_without_an_estimate_where_nothing_can_happen) {
  const RareRow row =
      rare_run(held_point("0.6", {"disturbance={}"}), {.splitting = {.particles = 5}}, 3, never)
          .value();
  EXPECT_TRUE(row.extinct);
  EXPECT_EQ(row.probability, 0.0);
  EXPECT_EQ(row.drives, 5);
}

TEST(RareRun, works_on_a_mujoco_vehicle_that_is_planned_for) {
  const Scenario scenario = load_scenario(
      "dubins_obstacles",
      {"controller.horizon=3", "controller.quantisation={state: 10, noise: 10, compressed: 10}",
       "controller.max_iterations=5", "limit.steps=6", "plant.kind=mujoco",
       "safe_set.obstacles=[{x: [0.75, 2], y: [-1, 2]}]", "disturbance.friction=0.1"});
  const RareRow row = rare_run(scenario, {.splitting = {.particles = 6}}, 1, never).value();
  EXPECT_GT(row.probability, 0.0);
  for (const RareDrive& found : row.found) {
    const Scenario alone = with_seeds(scenario, found.seeds);
    EXPECT_EQ(outcome_name(run_episode(alone, {.seed = alone.seed}).outcome), found.outcome);
  }
}

}  // namespace rare_run_test
}  // namespace qsmpc::harness
