#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_deadline_test {

using namespace testing;

constexpr double kNoTime = 1e-9;     // s; elapses before anything can begin
constexpr double kAllTime = 3600.0;  // s

/// Requirements on a plan, however little time there was for it.
void expect_usable(const Plan& plan, const PlannerSettings& settings) {
  EXPECT_TRUE(std::isfinite(plan.cost.total()));
  EXPECT_TRUE(plan.policy.inputs.allFinite());
  EXPECT_TRUE((plan.policy.inputs.array() >= settings.bounds.lower[0]).all());
  EXPECT_TRUE((plan.policy.inputs.array() <= settings.bounds.upper[0]).all());
  ASSERT_EQ(static_cast<int>(plan.prediction.stages.size()), settings.horizon + 1);
  for (const DiscreteMeasure& stage : plan.prediction.stages) {
    EXPECT_NO_THROW(check_measure(stage));
  }
  EXPECT_FALSE(plan.fallback);
}

TEST(PlannerDeadline, must_be_positive) {
  const auto car = dubins_car();
  for (const double deadline : {0.0, -0.5, std::nan("")}) {
    PlannerSettings settings = dubins_settings();
    settings.deadline = deadline;
    EXPECT_THROW(Planner(*car, settings), std::invalid_argument) << deadline;
  }
}

TEST(PlannerDeadline, a_plan_without_time_is_predicted_priced_and_marked) {
  const auto car = dubins_car();
  for (const char* solver : {"lbfgs", "slsqp"}) {
    PlannerSettings settings = dubins_settings();
    settings.solver = solver;
    settings.deadline = kNoTime;
    Planner planner(*car, settings);
    Gaussian belief = dubins_belief();
    for (int step = 0; step < 4; ++step) {
      SCOPED_TRACE(std::string(solver) + ", plan " + std::to_string(step));
      const Plan& plan = planner.plan(belief);
      EXPECT_EQ(plan.status, SolverStatus::kDeadline);
      EXPECT_LE(plan.evaluations, 1);
      EXPECT_EQ(plan.warm, step > 0);
      expect_usable(plan, settings);
      // The cost belongs to this policy and belief: a planner with time agrees.
      settings.deadline = kAllTime;
      Planner other(*car, settings);
      EXPECT_EQ(plan.cost.total(), other.prescribe(belief, plan.policy.inputs).cost.total());
      belief.mean = plan.policy.states.col(1);
    }
  }
}

TEST(PlannerDeadline, a_plan_without_time_is_the_shifted_plan_before) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.cost.target << 2.0, 5.0, 0.0;
  settings.deadline = kNoTime;
  Planner planner(*car, settings);
  const Eigen::MatrixXd before = planner.plan(dubins_belief()).policy.inputs;
  Gaussian next = dubins_belief();
  next.mean = nominal_states(*car, next.mean, before).col(1);
  const Plan& plan = planner.plan(next);
  EXPECT_EQ(plan.policy.inputs.leftCols(4), before.rightCols(4));
}

TEST(PlannerDeadline, one_that_is_never_reached_changes_no_bit) {
  const auto car = dubins_car();
  for (const char* solver : {"lbfgs", "slsqp"}) {
    PlannerSettings settings = dubins_settings();
    settings.solver = solver;
    Planner unhurried(*car, settings);
    settings.deadline = kAllTime;
    Planner hurried(*car, settings);
    Gaussian belief = dubins_belief();
    for (int step = 0; step < 4; ++step) {
      const Plan& one = unhurried.plan(belief);
      const Plan& two = hurried.plan(belief);
      EXPECT_EQ(one.policy.inputs, two.policy.inputs) << solver << step;
      EXPECT_EQ(one.cost.total(), two.cost.total()) << solver << step;
      EXPECT_EQ(one.evaluations, two.evaluations) << solver << step;
      EXPECT_EQ(one.status, two.status) << solver << step;
      belief.mean = one.policy.states.col(1);
    }
  }
}

}  // namespace planner_deadline_test
}  // namespace qsmpc::controller
