#include "harness/episode/driver_pool.hpp"

#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/solvers/ocp_solver.hpp"
#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace driver_pool_test {

Scenario short_scenario(const std::string& choice, const std::string& name = "dubins_obstacles") {
  return load_scenario(
      name,
      {"controller.horizon=5", "controller.quantisation={state: 20, noise: 20, compressed: 20}",
       "limit.steps=8", "plant.kind=analytic", "vehicle.footprint=point", choice});
}

/// All numbers of an episode, to the last bit.
std::vector<double> numbers_of(const Trace& trace) {
  std::vector<double> numbers;
  const auto add = [&numbers](const auto& values) {
    numbers.insert(numbers.end(), values.data(), values.data() + values.size());
  };
  for (const StepRecord& step : trace.steps) {
    add(step.state);
    add(step.plan_inputs);
    add(step.disturbance);
    numbers.push_back(step.cost.total());
    numbers.push_back(step.iterations);
    for (const controller::DiscreteMeasure& stage : step.particles) add(stage.locations);
    for (const controller::StageCertificate& certificate : step.certificates) {
      numbers.push_back(certificate.value);
    }
  }
  add(trace.final_state);
  return numbers;
}

TEST(EpisodeDriver, an_episode_does_not_depend_on_those_driven_before) {
  std::vector<std::string> choices = {"controller.optimise_gain=true",
                                      "disturbance.sensor=[0.01, 0.01, 0.001]",
                                      "controller.propagator=soft"};
  for (const controller::SolverEntry& entry : controller::solvers())
    choices.push_back("controller.solver=" + entry.name);
  for (const controller::InputBoundingEntry& entry : controller::input_boundings()) {
    choices.push_back("controller.input_bounding=" + entry.name);
  }
  for (const std::string& choice : choices) {
    SCOPED_TRACE(choice);
    const Scenario scenario = short_scenario(choice);
    EpisodeDriver driver(scenario);
    const std::vector<double> first = numbers_of(driver.run({.seed = 1}));
    const std::vector<double> second = numbers_of(driver.run({.seed = 2}));
    ASSERT_FALSE(first.empty());
    EXPECT_NE(first, second);
    EXPECT_EQ(second, numbers_of(run_episode(scenario, {.seed = 2})));
    EXPECT_EQ(first, numbers_of(driver.run({.seed = 1})));
  }
}

TEST(EpisodeDriver, goes_on_after_an_episode_that_was_cut_short_and_in_mujoco) {
  const Scenario scenario = short_scenario("plant.kind=mujoco");
  EpisodeDriver driver(scenario);
  int asked = 0;
  const Trace cut = driver.run({.seed = 1, .should_stop = [&asked] { return ++asked > 3; }});
  EXPECT_EQ(cut.outcome, Outcome::kInterrupted);
  EXPECT_EQ(numbers_of(driver.run({.seed = 2})), numbers_of(run_episode(scenario, {.seed = 2})));
}

TEST(DriverPool, gives_every_thread_and_scenario_its_own_episodes) {
  const std::vector<Scenario> scenarios = {
      short_scenario("controller.policy=closed_loop"),
      short_scenario("controller.policy=open_loop"),
      short_scenario("controller.policy=closed_loop", "dubins_corridor")};
  constexpr std::uint64_t kSeeds = 4;
  // With room for none, for some, and for all of the scenarios.
  for (const std::size_t limit : {0, 2, 12}) {
    DriverPool pool(limit);
    std::vector<std::vector<double>> found(scenarios.size() * kSeeds);
    {
      std::vector<std::jthread> threads;
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        threads.emplace_back([&, seed] {
          for (std::size_t n = 0; n < scenarios.size(); ++n) {
            found[n * kSeeds + seed] = numbers_of(pool.run(scenarios[n], {.seed = seed}));
          }
        });
      }
    }
    for (std::size_t n = 0; n < scenarios.size(); ++n) {
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        EXPECT_EQ(found[n * kSeeds + seed], numbers_of(run_episode(scenarios[n], {.seed = seed})))
            << "limit " << limit << ", scenario " << n << ", seed " << seed;
      }
    }
  }
}

}  // namespace driver_pool_test
}  // namespace qsmpc::harness
