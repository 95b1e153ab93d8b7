// The cost with few points in place of that with all of them.
#include "controller/planning/coarse_cost.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "controller/planning/plan_evaluator.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace coarse_cost_test {

using namespace testing;

using Eigen::VectorXd;

PlannerSettings with_points(int points) {
  PlannerSettings settings = block_settings();
  settings.state_points = points;
  settings.noise_points = points;
  settings.compressed_points = points;
  return settings;
}

/// A plan that steers as `inputs`, predicted with all points.
class PredictedPlan : public ::testing::Test {
 protected:
  void predict(const VectorXd& inputs) {
    evaluator.set_policy(inputs.transpose(), Eigen::MatrixXd::Zero(1, 3), plan);
    evaluator.predict_and_evaluate(plan);
  }

  void SetUp() override {
    evaluator.take_belief(dubins_belief());
    predict(VectorXd::LinSpaced(settings.horizon, -0.8, 0.5));
  }

  std::unique_ptr<const models::Dynamics> car = dubins_car();
  PlannerSettings settings = with_points(60);
  PlanEvaluator evaluator{*car, settings};
  Plan plan;
};

using CoarseCostAbout = PredictedPlan;

TEST_F(CoarseCostAbout, a_plan_has_its_value_and_gradient) {
  CoarseCost* const coarse = evaluator.coarse_about(plan);
  ASSERT_NE(coarse, nullptr);
  const VectorXd z = plan.policy.inputs.reshaped();
  VectorXd gradient(z.size());
  VectorXd coarse_gradient(z.size());
  const double value = evaluator.cost().evaluate(z, gradient);
  EXPECT_NEAR(coarse->evaluate(z, coarse_gradient), value, 1e-12 * value);
  EXPECT_LE((coarse_gradient - gradient).norm(), 1e-10 * gradient.norm());
  // Elsewhere the two differ, but by much less than the cost changes.
  const VectorXd moved = z + VectorXd::LinSpaced(z.size(), 0.1, -0.2);
  const double change = std::abs(evaluator.cost().evaluate(moved) - value);
  const double difference = std::abs(coarse->evaluate(moved) - evaluator.cost().evaluate(moved));
  EXPECT_GT(difference, 0.0);
  EXPECT_LT(difference, 0.1 * change);
}

TEST_F(CoarseCostAbout, a_plan_has_a_gradient_that_equals_central_differences) {
  CoarseCost* const coarse = evaluator.coarse_about(plan);
  ASSERT_NE(coarse, nullptr);
  const VectorXd z =
      plan.policy.inputs.reshaped() + VectorXd::LinSpaced(settings.horizon, 0.2, -0.1);
  VectorXd gradient(z.size());
  const double value = coarse->evaluate(z, gradient);
  EXPECT_EQ(coarse->evaluate(z), value);
  constexpr double kStep = 1e-6;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const VectorXd step = kStep * VectorXd::Unit(z.size(), j);
    const double slope = (coarse->evaluate(z + step) - coarse->evaluate(z - step)) / (2.0 * kStep);
    EXPECT_NEAR(gradient[j], slope, 1e-6 * (std::abs(slope) + value)) << j;
  }
}

/// Minimises the coarse cost about the plan, then predicts the result, `rounds` times, or the cost
/// with all points in its place. Returns the cost of the last plan.
double cost_after_rounds(PlanEvaluator& evaluator, const PlannerSettings& settings, Plan plan,
                         int rounds, bool coarsely) {
  const auto solver = make_solver("lbfgs", {.bounding = "bounded"});
  for (int n = 0; n < rounds; ++n) {
    evaluator.hold(plan);
    CoarseCost* const coarse = coarsely ? evaluator.coarse_about(plan) : nullptr;
    const OcpProblem problem{.cost =
                                 [&](const VectorXd& z, VectorXd& gradient) {
                                   return coarse != nullptr
                                              ? coarse->evaluate(z, gradient)
                                              : evaluator.cost().evaluate(z, gradient);
                                 },
                             .lower = settings.bounds.lower.replicate(settings.horizon, 1),
                             .upper = settings.bounds.upper.replicate(settings.horizon, 1),
                             .constraints = {}};
    const VectorXd z = solver->minimise(problem, plan.policy.inputs.reshaped(), {}).z;
    evaluator.set_policy(z.transpose(), plan.gain_change, plan);
    evaluator.predict_and_evaluate(plan);
  }
  return plan.cost.total();
}

TEST_F(CoarseCostAbout, successive_plans_leads_to_the_minimum_with_all_points) {
  const double start = plan.cost.total();
  const double all = cost_after_rounds(evaluator, settings, plan, 6, /*coarsely=*/false);
  ASSERT_LT(all, 0.9 * start);
  EXPECT_NEAR(cost_after_rounds(evaluator, settings, plan, 3, /*coarsely=*/true), all, 2e-3 * all);
  EXPECT_LT(cost_after_rounds(evaluator, settings, plan, 6, /*coarsely=*/true), 1.0005 * all);
}

TEST_F(CoarseCostAbout, a_plan_that_is_not_finite_cannot_be_matched) {
  FragileCar fragile;
  PlanEvaluator broken(fragile, settings);
  broken.take_belief(dubins_belief());
  fragile.broken = true;
  broken.set_policy(plan.policy.inputs, plan.gain_change, plan);
  broken.predict_and_evaluate(plan);
  EXPECT_EQ(broken.coarse_about(plan), nullptr);
}

TEST(CoarseCost, is_made_for_many_points_and_solvers_without_constraints) {
  const auto car = dubins_car();
  const auto is_made = [&](int points, const char* solver) {
    PlannerSettings settings = with_points(points);
    settings.solver = solver;
    PlanEvaluator evaluator(*car, settings);
    evaluator.take_belief(dubins_belief());
    Plan plan;
    evaluator.set_policy(Eigen::MatrixXd::Zero(1, settings.horizon), Eigen::MatrixXd::Zero(1, 3),
                         plan);
    evaluator.predict_and_evaluate(plan);
    return evaluator.coarse_about(plan) != nullptr;
  };
  EXPECT_TRUE(is_made(48, "lbfgs"));
  EXPECT_FALSE(is_made(47, "lbfgs"));
  EXPECT_FALSE(is_made(48, "slsqp"));
}

}  // namespace coarse_cost_test
}  // namespace qsmpc::controller
