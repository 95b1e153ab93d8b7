// The effort of feedback under a limited risk: chosen by the certified value unless it is given.
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/planner.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace effort_choice_test {

using namespace testing;

/// A block in the path of a car whose cost barely penalises steering: the gains of that cost are
/// stiff.
PlannerSettings stiff(double plan, std::optional<double> effort) {
  PlannerSettings settings = block_settings();
  settings.penalty.box = 0.0;
  settings.penalty.obstacle = 0.0;
  settings.cost.input *= 0.01;
  settings.noise_covariance = Eigen::Vector3d(2e-3, 2e-3, 1e-3).asDiagonal();
  settings.feedback_effort = effort;
  settings.max_evaluations = 300;
  settings.risk.plan = plan;
  settings.safe_set.obstacles = {
      Box{.lower = Eigen::Vector3d(1.2, -0.3, -1e9), .upper = Eigen::Vector3d(1.5, 0.35, 1e9)}};
  return settings;
}

Gaussian near_start() {
  return {.mean = Eigen::Vector3d::Zero(),
          .covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-3).asDiagonal()};
}

double norm_of_gains(const Plan& plan) { return plan.policy.gains.front().norm(); }

TEST(EffortChoice, is_gentler_where_stiff_gains_cannot_be_certified) {
  const auto car = dubins_car();
  Planner chosen(*car, stiff(0.02, std::nullopt));
  Planner fixed(*car, stiff(0.02, 1.0));
  const Plan& free = chosen.plan(near_start());
  const Plan& bound = fixed.plan(near_start());
  EXPECT_TRUE(free.risk.kept) << free.risk.plan;
  EXPECT_FALSE(bound.risk.kept) << bound.risk.plan;
  EXPECT_LT(norm_of_gains(free), 0.5 * norm_of_gains(bound));
}

/// Inputs and gains of the first stages during a noise-free drive of `periods` periods.
std::vector<Eigen::MatrixXd> drive(Planner& planner, int periods) {
  std::vector<Eigen::MatrixXd> driven;
  Gaussian belief = near_start();
  for (int n = 0; n < periods; ++n) {
    const Plan& plan = planner.plan(belief);
    driven.emplace_back(plan.policy.inputs);
    driven.push_back(plan.policy.gains.front());
    belief.mean = plan.policy.states.col(1);
  }
  return driven;
}

/// The steps of the ladder of efforts, two per decade, that give the plan's gains for its inputs.
std::vector<int> steps_of(const Plan& plan, const Gaussian& belief) {
  std::vector<int> steps;
  const auto car = dubins_car();
  for (int step = -4; step <= 7; ++step) {
    Planner fixed(*car, stiff(0.02, std::pow(10.0, 0.5 * step)));
    const Plan& same = fixed.prescribe(belief, plan.policy.inputs);
    if (same.policy.gains.front().isApprox(plan.policy.gains.front(), 1e-6)) steps.push_back(step);
  }
  return steps;
}

TEST(EffortChoice, follows_the_drive_in_steps_to_a_neighbour) {
  const auto car = dubins_car();
  Planner planner(*car, stiff(0.02, std::nullopt));
  Gaussian belief = near_start();
  std::vector<int> driven;
  for (int n = 0; n < 15; ++n) {
    const Plan& plan = planner.plan(belief);
    const std::vector<int> steps = steps_of(plan, belief);
    ASSERT_EQ(steps.size(), 1U) << "period " << n;
    driven.push_back(steps.front());
    belief.mean = plan.policy.states.col(1);
  }
  // The first plan searches the whole ladder.
  int changes = 0;
  for (std::size_t n = 1; n < driven.size(); ++n) {
    EXPECT_LE(std::abs(driven[n] - driven[n - 1]), 1) << "period " << n;
    changes += driven[n] == driven[n - 1] ? 0 : 1;
  }
  EXPECT_GT(changes, 0) << ::testing::PrintToString(driven);
}

// Campaigns drive one episode after another with the same planner.
TEST(EffortChoice, begins_anew_after_a_reset_whatever_was_driven_before) {
  const auto car = dubins_car();
  Planner fresh(*car, stiff(0.02, std::nullopt));
  const std::vector<Eigen::MatrixXd> expected = drive(fresh, 10);
  EXPECT_NE(expected[1], expected[15]) << "the gains follow the drive";
  for (const int before : {1, 2, 3, 8}) {
    Planner used(*car, stiff(0.02, std::nullopt));
    (void)drive(used, before);
    used.reset();
    EXPECT_EQ(drive(used, 10), expected) << "after " << before << " periods";
  }
}

TEST(EffortChoice, is_that_of_the_cost_without_limits_and_what_is_given_with_them) {
  const auto car = dubins_car();
  const Eigen::MatrixXd inputs = Eigen::MatrixXd::Constant(1, stiff(1.0, {}).horizon, 0.1);
  const auto gains = [&](double plan, std::optional<double> effort) {
    Planner planner(*car, stiff(plan, effort));
    (void)planner.plan(near_start());
    return norm_of_gains(planner.prescribe(near_start(), inputs));
  };
  EXPECT_DOUBLE_EQ(gains(kInfinity, std::nullopt), gains(kInfinity, 1.0));
  EXPECT_DOUBLE_EQ(gains(0.02, 50.0), gains(kInfinity, 50.0));
  EXPECT_LT(gains(0.02, 50.0), gains(0.02, 1.0));
}

TEST(EffortChoice, must_be_positive) {
  const auto car = dubins_car();
  for (const double effort : {0.0, -1.0, kInfinity, std::nan("")}) {
    EXPECT_THROW(Planner(*car, stiff(0.02, effort)), std::invalid_argument);
  }
}

}  // namespace effort_choice_test
}  // namespace qsmpc::controller
