#include "harness/mismatch/closed_loop.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/episode/episode.hpp"
#include "harness/statistics/exceedance.hpp"
#include "tests/support/executors.hpp"
#include "tests/unit/mismatch/mismatch_fixture.hpp"

namespace qsmpc::harness {
namespace closed_loop_test {

EpisodeResult judged(const std::string& outcome, double cost, double clearance) {
  EpisodeResult result;
  result.outcome = outcome;
  result.cost = cost;
  result.min_clearance = clearance;
  result.unsafe = clearance <= 0.0;
  return result;
}

TEST(ClosedLoop, counts_outcomes_and_unsafe_episodes_with_their_limits) {
  const ClosedLoop loop = closed_loop_of(
      {judged("reached", 10.0, 0.4), judged("reached", 14.0, 0.2), judged("collision", 6.0, -0.1)});
  EXPECT_EQ(loop.episodes, 3);
  EXPECT_EQ(loop.outcomes.at("reached"), 2);
  EXPECT_EQ(loop.outcomes.at("collision"), 1);
  EXPECT_DOUBLE_EQ(loop.cost, 10.0);
  EXPECT_DOUBLE_EQ(loop.cost_deviation, std::sqrt(32.0 / 2.0 / 3.0));
  EXPECT_DOUBLE_EQ(loop.min_clearance, -0.1);
  EXPECT_EQ(loop.unsafe, 1);
  EXPECT_EQ(loop.unsafe_limits.upper, clopper_pearson(1, 3, 0.005).upper);
  EXPECT_THROW((void)closed_loop_of({}), std::invalid_argument);
}

TEST(ClosedLoop, unsafe_periods_are_held_against_what_was_certified_for_them) {
  EpisodeResult episode = judged("collision", 1.0, -0.1);
  episode.certified = {1e-3, 2e-3, 3e-3};
  episode.unsafe_next = {0, 0, 1};
  const ClosedLoop loop = closed_loop_of({episode});
  EXPECT_EQ(loop.periods, 3);
  EXPECT_EQ(loop.unsafe_periods, 1);
  EXPECT_DOUBLE_EQ(loop.certified_periods, 6e-3);
  // Periods 0 and 2, and period 1 with the certificate repeated for the missing period 3.
  EXPECT_DOUBLE_EQ(loop.p_value, exceedance_p_value({{.events = 1, .certified = 4e-3},
                                                     {.events = 0, .certified = 5e-3}}));
  EXPECT_LT(loop.p_value, 0.5) << "1 would hide what is in the sums";
  episode.certified = {1e-6, 1e-6, 1e-6};
  EXPECT_LT(closed_loop_of({episode}).p_value, 0.01);
}

TEST(EpisodeResult, says_of_each_period_what_was_certified_and_what_happened) {
  // Too fast to turn back in front of the wall.
  const Scenario scenario =
      testing::short_scenario({"safe_set.bounds.x=[-1, 0.4]", "target.state=[0.3, 2.5, 0]",
                               "controller.input_bounds.yaw_rate=[-0.2, 0.2]"});
  const Trace trace = run_episode(scenario, {.seed = 3});
  const EpisodeResult result = episode_result(EpisodeView(trace));
  ASSERT_EQ(result.outcome, "left_bounds");
  EXPECT_EQ(result.seed, 3U);
  ASSERT_EQ(result.certified.size(), trace.steps.size());
  EXPECT_EQ(result.certified[1], trace.steps[1].certificates.front().value);
  EXPECT_EQ(result.unsafe_next.back(), 1);
  EXPECT_EQ(result.unsafe_next.front(), 0);
  EXPECT_TRUE(result.unsafe);
  EXPECT_GE(result.magnitude[0], 0.4);
}

TEST(RunEpisodes, take_successive_seeds_and_do_not_depend_on_the_executor) {
  const Scenario scenario = testing::short_scenario();
  SharedWork work(6, {}, {});
  const auto reference = run_episodes(scenario, 3, controller::run_in_turn, work);
  const auto threaded = run_episodes(scenario, 3, testing::run_on_threads, work);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(reference[n].seed, scenario.seed + n);
    EXPECT_EQ(threaded[n].cost, reference[n].cost);
    EXPECT_EQ(threaded[n].residuals, reference[n].residuals);
  }
  EXPECT_NE(reference[0].cost, reference[1].cost);
  EXPECT_EQ(run_episode(scenario, {.seed = scenario.seed + 1}).steps.size(),
            static_cast<std::size_t>(reference[1].steps));
}

}  // namespace closed_loop_test
}  // namespace qsmpc::harness
