// Plans under chance constraints: around a block, repeatedly, and in infeasible situations.
#include "controller/chance/chance_planner.hpp"

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/regions/unsafe_set.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace chance_planner_test {

using namespace testing;

ChancePlannerSettings settings_of(const std::string& constraint) {
  ChancePlannerSettings settings{.problem = block_settings(), .constraint = constraint};
  settings.problem.noise_covariance = Eigen::Vector3d(5e-5, 5e-5, 5e-5).asDiagonal();
  settings.problem.cost.angles = {2};
  // Farther away, so that every method has room to turn.
  std::get<Box>(settings.problem.safe_set.obstacles.front().form).lower[0] += 0.3;
  std::get<Box>(settings.problem.safe_set.obstacles.front().form).upper[0] += 0.3;
  settings.chance.paths = 50;
  settings.chance.risk = 0.1;
  return settings;
}

Gaussian small_belief() {
  return {.mean = Eigen::Vector3d::Zero(), .covariance = 5e-5 * Eigen::Matrix3d::Identity()};
}

std::vector<std::string> all_constraints() {
  std::vector<std::string> names;
  for (const ChanceConstraintEntry& entry : chance_constraints()) names.push_back(entry.name);
  return names;
}

class EveryConstraint : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryConstraint, drives_round_a_block_without_touching_it) {
  const auto car = dubins_car();
  const ChancePlannerSettings settings = settings_of(GetParam());
  const UnsafeSet unsafe(settings.problem.safe_set);
  ChancePlanner planner(*car, settings);
  Gaussian belief = small_belief();
  for (int period = 0; period < 25; ++period) {
    const ChancePlan& plan = planner.plan(belief, period);
    // Redrawn paths may require slightly more than the previous ones did.
    const bool samples = chance_constraint_entry(GetParam()).samples;
    EXPECT_LE(plan.violation, samples ? 5e-3 : 0.0) << "period " << period;
    EXPECT_EQ(plan.status == SolverStatus::kInfeasible, plan.violation > 0.0);
    for (Eigen::Index k = 1; k <= plan.policy.horizon(); ++k) {
      EXPECT_GT(clearance(plan.policy.states.col(k), unsafe), 0.0);
    }
    EXPECT_GE(plan.believed, 0.0);
    EXPECT_LE(plan.believed, settings.chance.risk * 1.001);
    belief.mean = plan.policy.states.col(1);
  }
  EXPECT_GT(belief.mean[0], 2.5);  // past the block
}

TEST_P(EveryConstraint, the_same_after_a_reset) {
  const auto car = dubins_car();
  ChancePlanner planner(*car, settings_of(GetParam()));
  planner.reset(7);
  const Eigen::MatrixXd first = planner.plan(small_belief(), 0).policy.inputs;
  (void)planner.plan(small_belief(), 1);
  planner.reset(7);
  EXPECT_EQ(planner.plan(small_belief(), 0).policy.inputs, first);
  if (planner.paths() == 0) return;
  planner.reset(8);
  EXPECT_NE(planner.plan(small_belief(), 0).policy.inputs, first);
}

TEST_P(EveryConstraint, says_where_it_cannot_be_kept) {
  const auto car = dubins_car();
  ChancePlannerSettings settings = settings_of(GetParam());
  // The only way is blocked: a block from wall to wall, before which the car cannot stop.
  std::get<Box>(settings.problem.safe_set.obstacles.front().form).lower[1] = -20.0;
  std::get<Box>(settings.problem.safe_set.obstacles.front().form).upper[1] = 20.0;
  std::get<Box>(settings.problem.safe_set.obstacles.front().form).lower[0] = 0.3;
  ChancePlanner planner(*car, settings);
  const ChancePlan& plan = planner.plan(small_belief(), 0);
  EXPECT_EQ(plan.status, SolverStatus::kInfeasible);
  EXPECT_GT(plan.violation, 0.01);
  EXPECT_TRUE(plan.policy.inputs.allFinite());
}

TEST_P(EveryConstraint, answers_when_there_is_no_time) {
  const auto car = dubins_car();
  ChancePlanner planner(*car, settings_of(GetParam()));
  const ChancePlan& plan =
      planner.plan(small_belief(), 0, std::chrono::steady_clock::now() - std::chrono::seconds(1));
  EXPECT_EQ(plan.status, SolverStatus::kDeadline);
  EXPECT_TRUE(plan.policy.inputs.allFinite());
}

INSTANTIATE_TEST_SUITE_P(table, EveryConstraint, ::testing::ValuesIn(all_constraints()),
                         [](const auto& each) { return each.param; });

TEST(ChancePlanner, refuses_invalid_settings) {
  const auto car = dubins_car();
  const auto refuses = [&](auto&& change) {
    ChancePlannerSettings settings = settings_of("cone");
    change(settings);
    EXPECT_THROW(ChancePlanner(*car, settings), std::invalid_argument);
  };
  refuses([](auto& settings) { settings.constraint = "conical"; });
  refuses([](auto& settings) { settings.chance.risk = 0.0; });
  refuses([](auto& settings) { settings.chance.risk = 1.0; });
  refuses([](auto& settings) { settings.chance.paths = -1; });
  refuses([](auto& settings) { settings.chance.radius = -0.1; });
  refuses([](auto& settings) { settings.chance.smoothing = 0.0; });
  refuses([](auto& settings) { settings.chance.memory = 3; });  // a cone samples no noise
  refuses([](auto& settings) { settings.problem.horizon = 0; });
}

TEST(Tube, keeps_room_for_what_feedback_adds_to_the_input) {
  const auto car = dubins_car();
  ChancePlannerSettings settings = settings_of("cone");
  settings.problem.closed_loop = true;
  settings.problem.cost.target << 0.0, 6.0, 0.0;  // to the left at once, as sharply as possible
  settings.problem.safe_set.obstacles.clear();
  ChancePlanner cone(*car, settings);
  EXPECT_NEAR(cone.plan(small_belief(), 0).policy.inputs(0, 1), 2.0, 1e-6);
  settings.tightened_inputs = true;
  ChancePlanner tube(*car, settings);
  const ChancePlan& plan = tube.plan(small_belief(), 0);
  EXPECT_LT(plan.policy.inputs.maxCoeff(), 2.0 - 0.01);
}

}  // namespace chance_planner_test
}  // namespace qsmpc::controller
