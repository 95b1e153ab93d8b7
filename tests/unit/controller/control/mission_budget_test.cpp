// A mission's budget: what remains for a plan, and drives that never overspend.
#include "controller/control/mission_budget.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "controller/control/controller.hpp"
#include "controller/prediction/policy.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace mission_budget_test {

using namespace testing;

/// A plan of ten stages straight on along x, 0.2 m each, with this next-step certificate.
Plan straight_plan(double certificate) {
  Plan plan;
  plan.policy.inputs = Eigen::MatrixXd::Zero(1, 10);
  plan.policy.states = Eigen::MatrixXd::Zero(3, 11);
  plan.policy.states.row(0) = Eigen::RowVectorXd::LinSpaced(11, 0.0, 2.0);
  plan.risk.stages.assign(10, certificate);
  return plan;
}

TEST(MissionBudget, limits_nothing_without_a_limit) {
  const auto car = dubins_car();
  MissionBudget budget(*car, kInfinity, Eigen::Vector3d::Zero());
  budget.spend(straight_plan(0.5));
  EXPECT_FALSE(budget.limits(Eigen::Vector3d::Zero(), 10, 100).any());
}

TEST(MissionBudget, gives_the_next_stage_what_is_left_and_a_plan_its_share) {
  const auto car = dubins_car();
  MissionBudget budget(*car, 0.02, Eigen::Vector3d(10.0, 0.0, 0.0));
  // Before any plan gives the speed, the maximum number of periods is used.
  RiskLimits limits = budget.limits(Eigen::Vector3d::Zero(), 10, 200);
  EXPECT_DOUBLE_EQ(limits.first, 0.02);
  EXPECT_DOUBLE_EQ(limits.plan, 0.02 * 10.0 / 200.0);
  EXPECT_TRUE(std::isinf(limits.stage));
  budget.spend(straight_plan(0.004));
  EXPECT_DOUBLE_EQ(budget.spent(), 0.004);
  // 10 m plus a fifth, at 0.2 m per period.
  limits = budget.limits(Eigen::Vector3d::Zero(), 10, 200);
  EXPECT_DOUBLE_EQ(limits.first, 0.016);
  EXPECT_NEAR(limits.plan, 0.016 * 10.0 / 60.0, 1e-12);
  // Near the target or the end of the drive, the plan may use the whole budget.
  EXPECT_DOUBLE_EQ(budget.limits(Eigen::Vector3d(9.5, 0.0, 0.0), 10, 200).plan, 0.016);
  EXPECT_DOUBLE_EQ(budget.limits(Eigen::Vector3d::Zero(), 10, 4).plan, 0.016);
  // Overspending leaves nothing; a new drive starts afresh.
  budget.spend(straight_plan(0.5));
  EXPECT_EQ(budget.limits(Eigen::Vector3d::Zero(), 10, 200).first, 0.0);
  budget.reset();
  EXPECT_EQ(budget.spent(), 0.0);
  EXPECT_DOUBLE_EQ(budget.limits(Eigen::Vector3d::Zero(), 10, 200).first, 0.02);
}

TEST(MissionBudget, a_known_way_counts_for_as_long_as_it_is) {
  const auto car = dubins_car();
  MissionBudget budget(*car, 0.02, Eigen::Vector3d(100.0, 0.0, 0.0));
  budget.spend(straight_plan(1e-4));
  const Eigen::VectorXd start = Eigen::Vector3d::Zero();
  const double straight = budget.limits(start, 10, 6000).plan;
  EXPECT_DOUBLE_EQ(budget.limits(start, 10, 6000, 120.0).plan, straight);
  EXPECT_LT(budget.limits(start, 10, 6000, 1200.0).plan, straight);
}

// Plans whose late stages carry their risk spend little, as they are replaced before.
TEST(MissionBudget, gives_plans_more_where_little_of_what_they_are_certified_is_spent) {
  const auto car = dubins_car();
  MissionBudget budget(*car, 0.02, Eigen::Vector3d(100.0, 0.0, 0.0));
  Plan plan = straight_plan(1e-6);
  plan.risk.stages.back() = 1e-3;
  budget.spend(plan);
  const double first = budget.limits(Eigen::Vector3d::Zero(), 10, 600).plan;
  for (int n = 0; n < 100; ++n) budget.spend(plan);
  EXPECT_NEAR(budget.spent(), 101e-6, 1e-12);
  const double later = budget.limits(Eigen::Vector3d::Zero(), 10, 600).plan;
  EXPECT_GT(later, 5.0 * first);
  // Never more than what is left.
  for (int n = 0; n < 10000; ++n) budget.spend(plan);
  EXPECT_LE(budget.limits(Eigen::Vector3d::Zero(), 10, 600).plan, 0.02 - budget.spent());
  // Plans certified 1 throughout do not count as unused risk.
  budget.reset();
  for (int n = 0; n < 3; ++n) {
    plan.risk.stages.assign(10, 1.0);
    plan.risk.stages.front() = 1e-3;
    budget.spend(plan);
  }
  EXPECT_LE(budget.limits(Eigen::Vector3d::Zero(), 10, 600).plan, 0.02 - budget.spent());
  EXPECT_GT(budget.limits(Eigen::Vector3d::Zero(), 10, 600).plan, 0.0);
}

// Past a block, on the model with its noise: the certificates of the plans in force add up to no
// more than the budget, and a smaller budget gives more clearance.
TEST(MissionBudget, drives_never_spend_more) {
  const auto car = dubins_car();
  ControllerSettings settings;
  settings.problem = block_settings();
  PlannerSettings& problem = settings.problem;
  problem.penalty.box = 0.0;
  problem.penalty.obstacle = 0.0;
  problem.feedback_effort = 10.0;
  problem.noise_covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();
  problem.safe_set.obstacles = {
      Box{.lower = Eigen::Vector3d(1.5, -0.3, -1e9), .upper = Eigen::Vector3d(2.0, 0.35, 1e9)}};
  NormalSampler noise(problem.noise_covariance);
  double last = kInfinity;
  for (const double limit : {0.2, 1e-3}) {
    settings.mission = limit;
    const auto controller = make_controller("quantised", *car, settings);
    Generator generator(17);
    Eigen::VectorXd state = Eigen::Vector3d::Zero();
    Gaussian belief{.mean = state, .covariance = problem.noise_covariance};
    double spent = 0.0;
    double nearest = kInfinity;
    for (int k = 0; k < 30; ++k) {
      const Decision& decision = controller->decide(
          {.period = k, .belief = belief, .observation = state, .periods_left = 30 - k});
      ASSERT_NE(decision.risk, nullptr);
      EXPECT_FALSE(decision.risk_exceeded) << "period " << k << ", limit " << limit;
      spent += decision.risk->stages.front();
      models::StateBatch after(3, 1);
      car->step(models::StateBatch(state), models::StateBatch(decision.input), after);
      belief.mean = after.col(0);
      state = after.col(0) + noise(generator);
      nearest = std::min(nearest, clearance(state, problem.safe_set));
    }
    EXPECT_LE(spent, limit);
    EXPECT_GT(spent, 0.0);
    EXPECT_GT(nearest, 0.0);
    EXPECT_GT(state[0], 2.0);
    EXPECT_LT(spent, last);
    last = spent;
    controller->reset();
  }
}

}  // namespace mission_budget_test
}  // namespace qsmpc::controller
