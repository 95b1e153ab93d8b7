#include "harness/assembly/memory_need.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace memory_need_test {

using ::testing::HasSubstr;

constexpr double kGiga = 1e9;

Scenario with_sizes(int horizon, int state, int noise, int compressed) {
  Scenario scenario = minimal_with({});
  scenario.controller.horizon = horizon;
  scenario.controller.quantisation.state = state;
  scenario.controller.quantisation.noise = noise;
  scenario.controller.quantisation.compressed = compressed;
  return scenario;
}

// Measured peaks of the process; the estimate only has to distinguish gigabytes from megabytes.
TEST(MemoryNeed, is_near_what_was_measured) {
  struct Measured {
    Scenario scenario;
    double giga;
  };
  for (const Measured& measured : {Measured{with_sizes(10, 10'000, 100, 10'000), 1.58},
                                   Measured{with_sizes(10, 10'000, 1'000, 10'000), 7.61},
                                   Measured{with_sizes(100, 10'000, 100, 10'000), 4.21},
                                   Measured{with_sizes(100, 1'000, 1'000, 1'000), 0.60},
                                   Measured{with_sizes(10, 100'000, 10, 100'000), 2.03}}) {
    const double need = memory_need(measured.scenario) / kGiga;
    EXPECT_GT(need, measured.giga / 5.0);
    EXPECT_LT(need, measured.giga * 5.0);
  }
  EXPECT_LT(memory_need(with_sizes(12, 100, 100, 100)), 0.02 * kGiga);
}

TEST(MemoryNeed, beyond_the_share_is_a_problem) {
  const Scenario large = with_sizes(1000, 100'000, 100, 100'000);
  const auto problem = memory_problem(large, 1, 64.0 * kGiga);
  ASSERT_TRUE(problem.has_value());
  EXPECT_THAT(problem->found, HasSubstr("a horizon of 1000 with 100000 state points"));
  EXPECT_THAT(problem->expected, HasSubstr("at most 48 GB, 75 % of the memory"));

  const Scenario usual = with_sizes(12, 100, 100, 100);
  EXPECT_FALSE(memory_problem(usual, 1, kGiga).has_value());
  EXPECT_TRUE(memory_problem(usual, 1000, kGiga).has_value());
}

TEST(MemoryNeed, a_controller_without_particles_needs_none) {
  Scenario large = with_sizes(1000, 100'000, 100, 100'000);
  large.controller.kind = "lqr";
  EXPECT_EQ(memory_need(large), 0.0);
}

TEST(MemoryNeed, of_a_controller_that_samples_is_that_of_its_samples) {
  Scenario large = with_sizes(1000, 100'000, 100, 100'000);
  large.controller.kind = "mppi";
  EXPECT_LT(memory_need(large), 0.1 * kGiga);
  large.controller.mppi.samples = 1'000'000;
  EXPECT_GT(memory_need(large), 8.0 * kGiga);  // 1000 inputs of 8 bytes each
  const auto problem = memory_problem(large, 1, kGiga);
  ASSERT_TRUE(problem.has_value());
  EXPECT_THAT(problem->found, HasSubstr("a horizon of 1000 with 1000000 samples"));
}

}  // namespace memory_need_test
}  // namespace qsmpc::harness
