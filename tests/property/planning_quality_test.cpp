// A plan costs hardly more than the best policy: by exact cost where it is known, elsewhere by the
// cost on simulated paths.
#include "tests/support/planning_quality.hpp"

#include <cctype>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/support/effort.hpp"

namespace qsmpc::controller {
namespace planning_quality_test {

using namespace testing;

class OpenLoopPlan : public ::testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(OpenLoopPlan, costs_hardly_more_than_the_exact_optimum) {
  const auto [horizon, allowed] = GetParam();
  const Shortfall shortfall =
      exact_shortfall(free_settings(horizon, /*closed_loop=*/false), first_belief(0.0, 0.0, 0.0));
  RecordProperty("more", std::to_string(shortfall.absolute()));
  RecordProperty("best", std::to_string(shortfall.best));
  EXPECT_LE(shortfall.absolute(), allowed) << "of " << shortfall.best;
  // Nothing costs less than an optimum.
  EXPECT_GE(shortfall.absolute(), -1e-10 * shortfall.best);
}

INSTANTIATE_TEST_SUITE_P(horizons, OpenLoopPlan,
                         ::testing::Values(std::tuple(8, 0.1), std::tuple(18, 0.5)));

class ClosedLoopPlan : public ::testing::TestWithParam<std::tuple<int, std::size_t>> {};

TEST_P(ClosedLoopPlan, costs_hardly_more_than_the_best_policy_that_was_found) {
  constexpr double kAllowed = 0.002;
  const auto [horizon, index] = GetParam();
  const Place place = places_among_blocks()[index];
  SamplingSettings sampling;
  sampling.search.draws.paths = by_effort(1000, 1000, 4000);
  sampling.search.random_starts = by_effort(0, 0, 20);
  const std::unique_ptr<const models::Dynamics> car = default_car();
  const Shortfall shortfall =
      sampled_shortfall(*car, blocks_settings(horizon), place.belief, sampling);
  RecordProperty("more_percent", std::to_string(100.0 * shortfall.relative()));
  RecordProperty("best", std::to_string(shortfall.best));
  EXPECT_LE(shortfall.relative(), kAllowed)
      << "planned " << shortfall.planned << ", best " << shortfall.best << "\nplanned inputs "
      << shortfall.plan.policy.inputs << "\nbest inputs    " << shortfall.best_inputs;
  // The search also starts from the plan: it ends at most a sampling error above it.
  EXPECT_GE(shortfall.relative(), -kAllowed) << "the search is not one";
}

std::string name_of(const ::testing::TestParamInfo<std::tuple<int, std::size_t>>& info) {
  const auto [horizon, index] = info.param;
  std::string name = std::to_string(horizon) + "_stages_" + places_among_blocks()[index].name;
  for (char& letter : name) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    horizons, ClosedLoopPlan,
    ::testing::Combine(::testing::Values(8, 12, 18),
                       ::testing::Range<std::size_t>(0, places_among_blocks().size())),
    name_of);

}  // namespace planning_quality_test
}  // namespace qsmpc::controller
