#include "controller/planning/plan_evaluator.hpp"

#include <cstddef>
#include <limits>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace plan_evaluator_test {

using namespace testing;

/// A plan that goes straight ahead, predicted from the belief that the evaluator has taken.
Plan straight_ahead(PlanEvaluator& evaluator) {
  Plan plan;
  plan.gain_change = Eigen::MatrixXd::Zero(1, 3);
  evaluator.set_policy(Eigen::MatrixXd::Zero(1, 5), plan.gain_change, plan);
  evaluator.predict_and_evaluate(plan);
  return plan;
}

TEST(PlanEvaluator, can_freeze_only_finite_predictions_from_the_same_weights) {
  const auto car = dubins_car();
  const PlannerSettings settings = dubins_settings();
  PlanEvaluator evaluator(*car, settings);
  evaluator.take_belief(dubins_belief());
  const Plan plan = straight_ahead(evaluator);
  EXPECT_TRUE(evaluator.can_freeze(plan));
  for (const std::size_t stage : {0, 2, 4}) {
    Plan broken = plan;
    broken.prediction.maps[stage].compression_w2 = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(evaluator.can_freeze(broken)) << stage;
  }
  Plan other = plan;
  other.prediction.stages[0].weights.head<2>() += Eigen::Vector2d(0.01, -0.01);
  EXPECT_FALSE(evaluator.can_freeze(other));
  other.prediction.stages[0].weights = plan.prediction.stages[0].weights.head(29);
  EXPECT_FALSE(evaluator.can_freeze(other));
}

TEST(PlanEvaluator, limits_the_risk_by_each_limit_alone) {
  const auto car = dubins_car();
  const PlannerSettings settings = dubins_settings();
  for (double RiskLimits::*limit : {&RiskLimits::first, &RiskLimits::stage, &RiskLimits::plan}) {
    PlanEvaluator evaluator(*car, settings);
    RiskLimits limits;
    limits.*limit = 1.0;  // always kept
    evaluator.set_limits(limits, 0);
    EXPECT_EQ(evaluator.risk(), nullptr);
    limits.*limit = 0.02;
    evaluator.set_limits(limits, 0);
    EXPECT_NE(evaluator.risk(), nullptr);
  }
}

}  // namespace plan_evaluator_test
}  // namespace qsmpc::controller
