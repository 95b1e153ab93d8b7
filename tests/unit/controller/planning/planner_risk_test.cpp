// Plans within limits of their certified risk, by every solver and kind of policy, and the fallback
// where there is none.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/planning/planner.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_risk_test {

using namespace testing;

/// A block in the way, known only to the limits.
PlannerSettings limited(double plan) {
  PlannerSettings settings = block_settings();
  settings.penalty.box = 0.0;
  settings.penalty.obstacle = 0.0;
  settings.noise_covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();
  settings.feedback_effort = 10.0;
  settings.max_evaluations = 300;
  settings.risk.plan = plan;
  // Far enough away to be avoided.
  settings.safe_set.obstacles = {
      Box{.lower = Eigen::Vector3d(1.2, -0.3, -1e9), .upper = Eigen::Vector3d(1.5, 0.35, 1e9)}};
  settings.safe_set.body = {.discs = {{.radius = 0.08, .offset = {0.1, 0.0}}, {.radius = 0.08}},
                            .x = 0,
                            .y = 1,
                            .heading = 2};
  return settings;
}

Gaussian near_start() {
  return {.mean = Eigen::Vector3d::Zero(),
          .covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal()};
}

/// By all bounds, not only those of the planner.
double certified(const Planner& planner, const Gaussian& belief, const Plan& plan) {
  const PredictedMotion motion = motion_of(planner, belief, plan);
  return horizon_bound(certify(motion, planner.settings().safe_set, error_budget(motion)));
}

TEST(PlannerRisk, limits_are_kept_and_used_by_every_solver_and_policy) {
  const auto car = dubins_car();
  for (const char* solver : {"lbfgs", "slsqp"}) {
    for (const char* policy : {"open", "closed", "gains"}) {
      SCOPED_TRACE(std::string(solver) + ", " + policy);
      PlannerSettings settings = limited(0.05);
      settings.solver = solver;
      settings.closed_loop = std::string(policy) != "open";
      settings.optimise_gain = std::string(policy) == "gains";
      Planner planner(*car, settings);
      const Plan& plan = planner.plan(near_start());
      EXPECT_TRUE(plan.risk.kept) << plan.risk.plan;
      EXPECT_NE(plan.status, SolverStatus::kRiskExceeded);
      EXPECT_LE(certified(planner, near_start(), plan), 0.05);
      EXPECT_LE(certified(planner, near_start(), plan), plan.risk.plan + 1e-12);
      // Unnecessary caution would cost.
      EXPECT_GT(plan.risk.plan, 0.02);
      const double cost = plan.cost.total();
      PlannerSettings careless = settings;
      careless.risk = {};
      Planner other(*car, careless);
      const Plan& unlimited = other.plan(near_start());
      EXPECT_GT(certified(other, near_start(), unlimited), 0.5);
      EXPECT_LT(unlimited.cost.total(), cost);
      EXPECT_TRUE(unlimited.risk.stages.empty());
    }
  }
}

/// An error with which no plan can be certified.
ModelError hopeless_error() { return model_error_of_size(Eigen::Vector3d(0.3, 0.3, 0.1)); }

TEST(PlannerRisk, the_model_alone_is_planned_for_where_its_error_leaves_no_plan) {
  const auto car = dubins_car();
  const PlannerSettings without = limited(0.05);
  PlannerSettings with = without;
  with.model_error = hopeless_error();
  with.otherwise = RiskOtherwise::kModel;
  Planner planner(*car, with);
  Planner errorless(*car, without);
  for (int period = 0; period < 3; ++period) {
    SCOPED_TRACE(period);
    Gaussian belief = near_start();
    belief.mean[0] += 0.1 * period;
    const Plan& plan = planner.plan(belief, {.period = period});
    const Plan& expected = errorless.plan(belief, {.period = period});
    EXPECT_EQ(plan.policy.inputs, expected.policy.inputs);
    EXPECT_EQ(plan.policy.gains, expected.policy.gains);
    // The certificate is for the plant, and the plan driven does not meet the limit.
    EXPECT_TRUE(expected.risk.kept);
    EXPECT_FALSE(plan.risk.kept);
    EXPECT_GT(plan.risk.plan, expected.risk.plan);
    EXPECT_EQ(plan.status, SolverStatus::kRiskExceeded);
  }
}

TEST(PlannerRisk, the_error_counts_where_a_plan_keeps_its_limit_with_it) {
  const auto car = dubins_car();
  PlannerSettings settings = limited(0.05);
  settings.model_error = model_error_of_size(Eigen::Vector3d(1e-4, 1e-4, 1e-4));
  settings.otherwise = RiskOtherwise::kModel;
  Planner planner(*car, settings);
  settings.otherwise = RiskOtherwise::kLeastRisk;
  Planner usual(*car, settings);
  const Plan& plan = planner.plan(near_start());
  EXPECT_TRUE(plan.risk.kept);
  EXPECT_EQ(plan.policy.inputs, usual.plan(near_start()).policy.inputs);
}

TEST(PlannerRisk, every_bounding_of_the_inputs_keeps_limits) {
  const auto car = dubins_car();
  for (const InputBoundingEntry& bounding : input_boundings()) {
    SCOPED_TRACE(bounding.name);
    PlannerSettings settings = limited(0.05);
    settings.input_bounding = bounding.name;
    Planner planner(*car, settings);
    const Plan& plan = planner.plan(near_start());
    EXPECT_TRUE(plan.risk.kept) << plan.risk.plan;
    EXPECT_TRUE((plan.policy.inputs.array().abs() <= 2.0).all());
  }
}

TEST(PlannerRisk, a_stage_limit_holds_of_each_and_a_smaller_limit_costs_more) {
  const auto car = dubins_car();
  double last = 0.0;
  for (const double limit : {0.2, 0.02, 2e-3, 2e-4}) {
    PlannerSettings settings = limited(kInfinity);
    settings.risk.stage = limit;
    Planner planner(*car, settings);
    const Plan& plan = planner.plan(near_start());
    EXPECT_TRUE(plan.risk.kept);
    for (const double stage : plan.risk.stages) EXPECT_LE(stage, limit);
    EXPECT_GT(plan.cost.total(), last);
    last = plan.cost.total();
  }
}

TEST(PlannerRisk, the_request_may_lower_a_limit) {
  const auto car = dubins_car();
  Planner planner(*car, limited(0.2));
  EXPECT_GT(planner.plan(near_start()).risk.plan, 0.05);
  planner.reset();
  const Plan& plan = planner.plan(near_start(), {.limits = {.first = 1e-3, .plan = 0.01}});
  EXPECT_TRUE(plan.risk.kept);
  EXPECT_LE(plan.risk.plan, 0.01);
  EXPECT_LE(plan.risk.stages.front(), 1e-3);
}

TEST(PlannerRisk, warm_plans_keep_limits_along_a_drive) {
  const auto car = dubins_car();
  Planner planner(*car, limited(0.05));
  Gaussian belief = near_start();
  for (int k = 0; k < 14; ++k) {
    const Plan& plan = planner.plan(belief);
    EXPECT_TRUE(plan.risk.kept) << "period " << k << ": " << plan.risk.plan;
    EXPECT_EQ(plan.warm, k > 0) << k;
    belief.mean = plan.policy.states.col(1);
  }
  // By now it is past the block, and was never in it.
  EXPECT_GT(belief.mean[0], 1.5);
}

TEST(PlannerRisk, a_model_error_is_certified_with) {
  const auto car = dubins_car();
  PlannerSettings settings = limited(0.05);
  Planner exact(*car, settings);
  const double cost = exact.plan(near_start()).cost.total();
  settings.model_error = model_error_of_size(Eigen::Vector3d(1e-3, 1e-3, 5e-4));
  settings.model_error->higher.fill(2.0 * settings.model_error->root_mean_square);
  Planner planner(*car, settings);
  const Plan& plan = planner.plan(near_start());
  EXPECT_TRUE(plan.risk.kept) << plan.risk.plan;
  EXPECT_GT(plan.cost.total(), cost);
  const Gaussian belief = near_start();
  PredictedMotion motion = motion_of(planner, belief, plan);
  motion.model_error = &*settings.model_error;
  EXPECT_LE(horizon_bound(certify(motion, settings.safe_set, error_budget(motion))), 0.05);
}

/// A wall across the path with a gap narrower than the body.
PlannerSettings closed_gap(double plan) {
  PlannerSettings settings = limited(plan);
  settings.safe_set.bounds.lower.head<2>() << -0.3, -0.6;
  settings.safe_set.bounds.upper.head<2>() << 6.0, 0.6;
  settings.safe_set.obstacles = {
      Box{.lower = Eigen::Vector3d(0.7, 0.05, -1e9), .upper = Eigen::Vector3d(1.0, 2.0, 1e9)},
      Box{.lower = Eigen::Vector3d(0.7, -2.0, -1e9), .upper = Eigen::Vector3d(1.0, -0.05, 1e9)}};
  return settings;
}

TEST(PlannerRisk, without_such_a_plan_the_least_risk_is_taken_and_reported) {
  const auto car = dubins_car();
  Planner planner(*car, closed_gap(0.05));
  const Plan& plan = planner.plan(near_start());
  EXPECT_FALSE(plan.risk.kept);
  EXPECT_EQ(plan.status, SolverStatus::kRiskExceeded);
  EXPECT_STREQ(solver_status_name(plan.status), "risk_exceeded");
  const double severity = plan.risk.severity;
  PlannerSettings careless = closed_gap(0.05);
  careless.risk = {};
  Planner other(*car, careless);
  const Eigen::MatrixXd unlimited = other.plan(near_start()).policy.inputs;
  EXPECT_LT(severity, planner.prescribe(near_start(), unlimited).risk.severity);
}

TEST(PlannerRisk, odd_limits_and_starts_are_answered) {
  const auto car = dubins_car();
  for (const double limit : {0.0, 1e-12}) {
    Planner planner(*car, limited(limit));
    const Plan& plan = planner.plan(near_start());
    EXPECT_FALSE(plan.risk.kept) << limit;
    EXPECT_EQ(plan.status, SolverStatus::kRiskExceeded);
    EXPECT_TRUE(std::isfinite(plan.cost.total()));
  }
  // A limit of 1 means no limit.
  PlannerSettings free = limited(kInfinity);
  Planner without(*car, free);
  free.risk.plan = 1.0;
  Planner with(*car, free);
  EXPECT_EQ(with.plan(near_start()).policy.inputs, without.plan(near_start()).policy.inputs);
  // In the block already; wider than the room.
  Gaussian inside = near_start();
  inside.mean.head<2>() << 1.3, 0.0;
  PlannerSettings wide = limited(0.05);
  wide.safe_set.bounds.lower.head<2>().setConstant(-1.0);
  wide.safe_set.bounds.upper.head<2>().setConstant(1.0);
  wide.safe_set.body.discs = {{.radius = 3.0}};
  Planner in_block(*car, limited(0.05));
  EXPECT_EQ(in_block.plan(inside).status, SolverStatus::kRiskExceeded);
  Planner no_room(*car, wide);
  const Plan& plan = no_room.plan(near_start());
  EXPECT_EQ(plan.status, SolverStatus::kRiskExceeded);
  EXPECT_EQ(plan.risk.plan, 1.0);
  PlannerSettings negative = limited(-0.1);
  EXPECT_THROW(Planner(*car, negative), std::invalid_argument);
}

/// A mass on a line before a wall.
PlannerSettings before_a_wall(RiskOtherwise otherwise) {
  PlannerSettings settings;
  settings.horizon = 15;
  settings.state_points = 30;
  settings.noise_points = 20;
  settings.compressed_points = 30;
  settings.noise_covariance = Eigen::Vector2d(1e-4, 1e-4).asDiagonal();
  settings.cost = {.state = Eigen::Vector2d(4.0, 0.1).asDiagonal(),
                   .input = Eigen::MatrixXd::Constant(1, 1, 0.01),
                   .terminal = Eigen::Vector2d(4.0, 0.1).asDiagonal(),
                   .target = Eigen::Vector2d(3.0, 0.0)};
  settings.penalty.box = 0.0;
  settings.safe_set = unbounded_safe_set(2);
  settings.safe_set.bounds.upper[0] = 1.0;
  settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -3.0),
                     .upper = Eigen::VectorXd::Constant(1, 3.0)};
  settings.risk.plan = 0.0;  // no plan meets it
  settings.otherwise = otherwise;
  return settings;
}

TEST(PlannerRisk, brakes_where_asked_and_possible) {
  const auto mass = models::make_dynamics("double_integrator", {}, 0.1);
  const Gaussian moving{.mean = Eigen::Vector2d(0.0, 1.0),
                        .covariance = 1e-4 * Eigen::Matrix2d::Identity()};
  Planner planner(*mass, before_a_wall(RiskOtherwise::kBrake));
  const Plan& plan = planner.plan(moving);
  EXPECT_EQ(plan.status, SolverStatus::kRiskExceeded);
  EXPECT_NEAR(plan.policy.states(1, plan.policy.horizon()), 0.0, 0.1);
  EXPECT_LT(plan.policy.inputs(0, 0), -2.0);
  PlannerSettings settings = limited(0.05);
  settings.otherwise = RiskOtherwise::kBrake;
  const auto car = dubins_car();
  EXPECT_THROW(Planner(*car, settings), std::invalid_argument);
  EXPECT_THROW((void)risk_otherwise("pray"), std::invalid_argument);
}

TEST(PlannerRisk, the_previous_plan_continues_where_asked) {
  const auto car = dubins_car();
  PlannerSettings settings = limited(0.05);
  settings.otherwise = RiskOtherwise::kPrevious;
  Planner planner(*car, settings);
  const Eigen::MatrixXd kept = planner.plan(near_start()).policy.inputs;
  Gaussian next = near_start();
  next.mean = planner.plan(near_start()).policy.states.col(1);
  planner.reset();
  ASSERT_TRUE(planner.plan(near_start()).risk.kept);
  // The following plan cannot meet its limit.
  const Plan& plan = planner.plan(next, {.limits = {.plan = 0.0}});
  EXPECT_EQ(plan.status, SolverStatus::kRiskExceeded);
  EXPECT_EQ(plan.policy.inputs.leftCols(settings.horizon - 1),
            kept.rightCols(settings.horizon - 1));
}

}  // namespace planner_risk_test
}  // namespace qsmpc::controller
