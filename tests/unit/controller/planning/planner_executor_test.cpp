// No plan depends on how its loops are executed.

#include <cstddef>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/executors.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_executor_test {

using namespace testing;

void expect_same_plan(const Plan& one, const Plan& other) {
  EXPECT_EQ(one.policy.inputs, other.policy.inputs);
  EXPECT_EQ(one.policy.gains, other.policy.gains);
  EXPECT_EQ(one.gain_change, other.gain_change);
  EXPECT_EQ(one.cost.total(), other.cost.total());
  EXPECT_EQ(one.evaluations, other.evaluations);
  for (std::size_t k = 0; k < one.prediction.stages.size(); ++k) {
    EXPECT_EQ(one.prediction.stages[k].locations, other.prediction.stages[k].locations) << k;
    EXPECT_EQ(one.prediction.stages[k].weights, other.prediction.stages[k].weights) << k;
  }
}

TEST(PlannerExecutor, plans_are_equal_bit_for_bit_however_tasks_are_run) {
  const auto car = dubins_car();
  for (const bool optimise_gain : {false, true}) {
    PlannerSettings settings = dubins_settings();
    settings.state_points = 3000;
    settings.compressed_points = 3000;
    settings.horizon = 3;
    settings.max_evaluations = 15;
    settings.optimise_gain = optimise_gain;
    settings.safe_set.obstacles.push_back(
        Box{.lower = Eigen::Vector3d(0.2, 0.1, -1e9), .upper = Eigen::Vector3d(0.4, 0.5, 1e9)});
    Planner in_turn(*car, settings);
    settings.run = run_backwards;
    Planner backwards(*car, settings);
    settings.run = run_on_threads;
    Planner on_threads(*car, settings);
    Gaussian belief = dubins_belief();
    for (int step = 0; step < 2; ++step) {
      const Plan& expected = in_turn.plan(belief);
      ASSERT_GT(expected.prediction.stages[1].size(), 2048);  // several tasks
      expect_same_plan(backwards.plan(belief), expected);
      expect_same_plan(on_threads.plan(belief), expected);
      belief.mean = expected.policy.states.col(1);
    }
  }
}

// A throwing executor is how a user's interrupt reaches a plan.
TEST(PlannerExecutor, is_asked_in_every_evaluation_of_few_particles_and_may_end_the_plan) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.max_evaluations = 15;
  int asked = 0;
  int most = std::numeric_limits<int>::max();
  settings.run = [&](int count, TaskRef task) {
    if (++asked > most) throw std::runtime_error("interrupted");
    run_in_turn(count, task);
  };
  Planner planner(*car, settings);
  const Plan plan = planner.plan(dubins_belief());
  ASSERT_LE(plan.prediction.stages[1].size(), kChunk);
  ASSERT_GT(plan.evaluations, 2);
  EXPECT_GE(asked, plan.evaluations);

  most = asked / 2;
  asked = 0;
  Planner interrupted(*car, settings);
  EXPECT_THROW((void)interrupted.plan(dubins_belief()), std::runtime_error);
  EXPECT_EQ(asked, most + 1) << "nothing goes on after it";
}

}  // namespace planner_executor_test
}  // namespace qsmpc::controller
