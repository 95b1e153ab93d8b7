// Drives whose noise is drawn with other seeds from a certain period on.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace noise_seeds_test {

using ::testing::HasSubstr;

Scenario noisy_scenario(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      "controller.horizon=3",
      "controller.quantisation={state: 10, noise: 10, compressed: 10}",
      "controller.max_iterations=5",
      "limit.steps=8",
      "vehicle.footprint=point",
      "disturbance.sensor=[0.01, 0.01, 0.001]",
      "estimator={kind: last_measurement}"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario("dubins_obstacles", overrides);
}

const std::vector<models::NoiseSeed> kOthers{{.from = 3, .seed = 70}, {.from = 6, .seed = 80}};

TEST(NoiseSeedsOfADrive, leave_everything_before_them_as_it_was_on_every_plant) {
  for (const char* kind : {"analytic", "mujoco"}) {
    const Scenario scenario = noisy_scenario({std::string("plant.kind=") + kind});
    const Trace plain = run_episode(scenario, {.seed = 7});
    const Trace other = run_episode(scenario, {.seed = 7, .noise = kOthers});
    ASSERT_GT(plain.steps.size(), 4U);
    ASSERT_GT(other.steps.size(), 4U);
    for (std::size_t k = 0; k <= 3; ++k) EXPECT_EQ(plain.steps[k].state, other.steps[k].state);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(plain.steps[k].observation, other.steps[k].observation);
      EXPECT_EQ(plain.steps[k].input, other.steps[k].input);
      EXPECT_EQ(plain.steps[k].disturbance, other.steps[k].disturbance);
    }
    EXPECT_NE(plain.steps[3].observation, other.steps[3].observation);
    EXPECT_NE(plain.steps[3].disturbance, other.steps[3].disturbance);
  }
}

TEST(NoiseSeedsOfADrive, draw_what_a_drive_of_that_seed_draws) {
  const Scenario scenario = noisy_scenario({"plant.kind=analytic"});
  const Trace of_seed = run_episode(scenario, {.seed = 70});
  const Trace other = run_episode(scenario, {.seed = 7, .noise = kOthers});
  ASSERT_GT(of_seed.steps.size(), 5U);
  ASSERT_GT(other.steps.size(), 5U);
  for (std::size_t k = 3; k < 6; ++k) {
    EXPECT_EQ(of_seed.steps[k].disturbance, other.steps[k].disturbance);
    // The difference recovers the observation noise from sums of different numbers: up to rounding.
    EXPECT_TRUE((of_seed.steps[k].observation - of_seed.steps[k].state)
                    .isApprox(other.steps[k].observation - other.steps[k].state, 1e-9));
  }
}

TEST(NoiseSeedsOfADrive, are_in_the_scenario_of_its_trace_which_drives_it_again) {
  const Scenario scenario = noisy_scenario({"plant.kind=analytic"});
  const Trace first = run_episode(scenario, {.seed = 7, .noise = kOthers});
  const Scenario recorded = parse_scenario(first.scenario_text);
  EXPECT_EQ(recorded.seed, 7U);
  EXPECT_EQ(recorded.disturbance.seeds, kOthers);
  const Trace again = run_episode(recorded, {.seed = recorded.seed});
  EXPECT_EQ(again.final_state, first.final_state);
  EXPECT_EQ(again.scenario_text, first.scenario_text);
}

TEST(NoiseSeedsOfADrive, change_nothing_where_there_are_none) {
  const Scenario scenario = noisy_scenario({"plant.kind=analytic"});
  EXPECT_THAT(to_yaml(scenario), ::testing::Not(HasSubstr("seeds")));
  const Trace plain = run_episode(scenario, {.seed = 7});
  const Trace none = run_episode(scenario, {.seed = 7, .noise = std::vector<models::NoiseSeed>()});
  EXPECT_EQ(plain.final_state, none.final_state);
  EXPECT_EQ(plain.scenario_text, none.scenario_text);
}

TEST(NoiseSeedsOfADrive, continue_without_certificates_as_with_them) {
  const Scenario scenario = noisy_scenario({"plant.kind=analytic", "risk={mission: 0.5}"});
  const Trace certified = run_episode(scenario, {.seed = 7});
  const Trace bare = run_episode(scenario, {.seed = 7, .certify = false});
  EXPECT_EQ(certified.final_state, bare.final_state);
  EXPECT_TRUE(bare.steps.front().certificates.empty());
}

std::string refusal_of(const std::string& seeds) {
  try {
    (void)noisy_scenario({"disturbance.seeds=" + seeds});
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(NoiseSeedsOfADrive, are_refused_where_they_are_not_ascending_or_not_whole) {
  EXPECT_THAT(refusal_of("[{from: 3, seed: 1}, {from: 3, seed: 2}]"),
              HasSubstr("a period after 3"));
  EXPECT_THAT(refusal_of("[{from: -1, seed: 1}]"), HasSubstr("from"));
  EXPECT_THAT(refusal_of("[{from: 3}]"), HasSubstr("seed"));
  EXPECT_THAT(refusal_of("[{from: 3, seed: 1, to: 4}]"), HasSubstr("to"));
  EXPECT_EQ(refusal_of("[{from: 0, seed: 18446744073709551615}]"), "not refused");
}

}  // namespace noise_seeds_test
}  // namespace qsmpc::harness
