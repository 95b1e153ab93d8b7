// Outcomes of drives whose true state is unsafe, whether they stop there or continue.
#include <algorithm>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "controller/regions/unsafe_part.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace episode_outcome_test {

/// Without a penalty, the path to the target leads through the unsafe set, given by `safe_set`.
Scenario blind_scenario(const std::string& safe_set, const std::string& more = "limit.steps=40") {
  return load_scenario(
      "dubins_obstacles",
      {"controller.horizon=5", "controller.quantisation={state: 20, noise: 20, compressed: 20}",
       "plant.kind=analytic", "target={state: [3, 0, 0], radius: 0.5}", "vehicle.footprint=point",
       "risk={}", "controller.penalty={box: 0, obstacle: 0}", "limit.steps=40",
       "initial_state.mean=[0, 0, 1]", "controller.input_bounds.yaw_rate=[-1.5, 1.5]",
       "safe_set=" + safe_set, more});
}

constexpr const char* kColumn =
    "{bounds: {x: [-1, 12], y: [-3, 3]}, obstacles: [{x: [0.6, 1.5], y: [-2, 2]}]}";
/// Too close for the turn that the initial heading requires.
constexpr const char* kWall = "{bounds: {x: [-1, 12], y: [-3, 0.3]}}";
constexpr const char* kGoOn = "limit.stop_when_unsafe=false";

TEST(EpisodeOutcome, ends_as_a_collision_where_the_true_state_enters_an_obstacle) {
  const Trace trace = run_episode(blind_scenario(kColumn), {.seed = 2});
  EXPECT_EQ(trace.outcome, Outcome::kCollision);
  EXPECT_LE(controller::clearance(trace.final_state, trace.scenario.safe_set), 0.0);
  for (const StepRecord& step : trace.steps) {
    EXPECT_GT(controller::clearance(step.state, trace.scenario.safe_set), 0.0);
  }
}

TEST(EpisodeOutcome, ends_as_left_bounds_where_the_true_state_leaves_them) {
  const Trace trace = run_episode(blind_scenario(kWall), {.seed = 2});
  EXPECT_EQ(trace.outcome, Outcome::kLeftBounds);
  EXPECT_GE(trace.final_state[1], 0.3);
}

TEST(EpisodeOutcome, that_continues_after_an_unsafe_state_ends_at_the_target_and_is_not_a_success) {
  for (const auto& [safe_set, outcome] :
       {std::pair(kColumn, Outcome::kCollision), std::pair(kWall, Outcome::kLeftBounds)}) {
    const Trace stopped = run_episode(blind_scenario(safe_set), {.seed = 2});
    const Trace through = run_episode(blind_scenario(safe_set, kGoOn), {.seed = 2});
    EXPECT_GT(through.steps.size(), stopped.steps.size());
    EXPECT_LT(through.steps.size(), 40U);
    EXPECT_EQ(through.outcome, outcome);
    EXPECT_LE((through.final_state.head(2) - Eigen::Vector2d(3.0, 0.0)).norm(), 0.5);
  }
}

TEST(EpisodeOutcome, the_first_unsafe_instant_decides_and_a_timeout_does_not_hide_it) {
  const Trace both = run_episode(
      blind_scenario(
          "{bounds: {x: [-1, 12], y: [-3, 0.3]}, obstacles: [{x: [1.6, 2.2], y: [-3, 2]}]}", kGoOn),
      {.seed = 2});
  EXPECT_EQ(both.outcome, Outcome::kLeftBounds);
  const controller::UnsafeSet unsafe(both.scenario.safe_set);
  EXPECT_TRUE(std::ranges::any_of(both.steps, [&](const StepRecord& step) {
    return controller::unsafe_part(step.state, unsafe) == controller::UnsafePart::kObstacle;
  })) << "a collision came later";
  Scenario out_of_time = blind_scenario(kColumn, kGoOn);
  out_of_time.step_limit = 10;
  const Trace late = run_episode(out_of_time, {.seed = 2});
  EXPECT_EQ(late.steps.size(), 10U);
  EXPECT_EQ(late.outcome, Outcome::kCollision);
}

TEST(EpisodeOutcome, what_an_episode_did_is_not_held_against_the_next_one_of_the_driver) {
  const Scenario scenario = blind_scenario(kColumn);
  EpisodeDriver driver(scenario);
  const Trace first = driver.run({.seed = 2});
  EXPECT_EQ(first.outcome, Outcome::kCollision);
  EXPECT_EQ(driver.run({.seed = 2}).steps.size(), first.steps.size());
}

TEST(EpisodeOutcome, an_interrupt_after_a_collision_is_an_interrupt) {
  int asked = 0;
  EpisodeOptions options{.seed = 2};
  options.should_stop = [&asked] { return ++asked > 8; };
  const Trace trace = run_episode(blind_scenario(kColumn, kGoOn), options);
  EXPECT_LE(controller::clearance(trace.final_state, trace.scenario.safe_set), 0.0);
  EXPECT_EQ(trace.outcome, Outcome::kInterrupted);
}

}  // namespace episode_outcome_test
}  // namespace qsmpc::harness
