// After warm-up planning does not allocate.
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/planner.hpp"
#include "tests/unit/allocation/allocation_problem.hpp"
#include "tests/unit/allocation/allocations.hpp"

namespace qsmpc::controller {
namespace planner_allocation_test {

using namespace testing;

TEST(AllocationCount, sees_every_kind_of_allocation) {
  std::vector<double> numbers;
  Eigen::VectorXd vector;
  const AllocationCount allocations;
  numbers.resize(10);
  EXPECT_EQ(allocations.count(), 1U);
  vector.resize(10);
  EXPECT_EQ(allocations.count(), 2U);
  void* volatile block = std::aligned_alloc(64, 128);  // volatile, so that it is not optimised away
  std::free(block);
  EXPECT_EQ(allocations.count(), 3U);
  numbers.resize(5);
  vector.setZero();
  EXPECT_EQ(allocations.count(), 3U);
}

class PlannerAllocations : public ::testing::TestWithParam<Case> {};

TEST_P(PlannerAllocations, none_after_a_rehearsal_along_the_path) {
  constexpr int kRehearsal = 12;
  constexpr int kPlans = 12;
  const auto dynamics = models::make_dynamics(GetParam().system, {}, 0.1);
  Planner planner(*dynamics, settings_of(GetParam(), *dynamics));
  Gaussian belief = belief_of(*dynamics);
  for (int n = 0; n < kRehearsal + kPlans; ++n) {
    const AllocationCount allocations;
    const Plan& plan = planner.plan(belief);
    const std::size_t count = allocations.count();
    if (n >= kRehearsal) {
      EXPECT_EQ(count, 0U) << "plan " << n;
    }
    ASSERT_TRUE(std::isfinite(plan.cost.total()));
    // As if the car were slightly off its predicted position.
    belief.mean = plan.policy.states.col(1);
    belief.mean[1] += 0.05 * std::sin(2.0 * n);
    belief.mean[2] += 0.03 * std::cos(3.0 * n);
  }
}

TEST_P(PlannerAllocations, none_for_the_same_beliefs_again) {
  constexpr int kPlans = 6;
  const auto dynamics = models::make_dynamics(GetParam().system, {}, 0.1);
  Planner planner(*dynamics, settings_of(GetParam(), *dynamics));
  for (int rehearsal = 0; rehearsal < 4; ++rehearsal) {
    planner.reset();
    Gaussian belief = belief_of(*dynamics);
    for (int n = 0; n < kPlans; ++n) {
      const AllocationCount allocations;
      const Plan& plan = planner.plan(belief);
      const std::size_t count = allocations.count();
      // A plan may be computed in any of three places, all of which have been used by then.
      if (rehearsal == 3) {
        EXPECT_EQ(count, 0U) << "plan " << n;
      }
      belief.mean = plan.policy.states.col(1);
    }
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* system : {"dubins", "bicycle"}) {
    for (const char* propagator : {"mixture", "noise_free"}) {
      all.push_back({.system = system, .propagator = propagator});
      all.push_back({.system = system, .closed_loop = true, .propagator = propagator});
      all.push_back(
          {.system = system, .closed_loop = true, .optimise_gain = true, .propagator = propagator});
    }
    all.push_back({.system = system, .closed_loop = true, .obstacles = false});
    all.push_back({.system = system, .closed_loop = true, .points = 1500});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(cases, PlannerAllocations, ::testing::ValuesIn(cases()),
                         [](const auto& information) { return name_of(information.param); });

}  // namespace planner_allocation_test
}  // namespace qsmpc::controller
