// The shield: passive where the other's next step is certified, and intervening where it is not.
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/control/controller.hpp"
#include "controller/control/decision_motion.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace shield_controller_test {

using namespace testing;

/// A block beside the path: turning towards it is worse than turning away.
ControllerSettings settings_beside(double distance) {
  ControllerSettings settings{.problem = dubins_settings()};
  PlannerSettings& problem = settings.problem;
  problem.noise_covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  problem.cost.target << 2.0, -3.0, -1.5;  // to the right, where the block is
  problem.penalty = {.box = 0.0, .obstacle = 0.0};
  problem.safe_set.bounds.lower.head<2>().setConstant(-10.0);
  problem.safe_set.obstacles.push_back(Box{.lower = Eigen::Vector3d(-1.0, -2.0, -1e9),
                                           .upper = Eigen::Vector3d(1.0, -distance, 1e9)});
  settings.shield = {.of = "nominal", .limit = 0.01};
  return settings;
}

Gaussian small_belief() {
  return {.mean = Eigen::Vector3d(0.0, 0.0, -0.3),
          .covariance = 1e-4 * Eigen::Matrix3d::Identity()};
}

double plan_certificate(const models::Dynamics& dynamics, const ControllerSettings& settings,
                        const Situation& situation, const Decision& decision) {
  DecisionMotion motions(dynamics, settings.problem);
  const PredictedMotion motion = motions.of(situation, decision, situation.belief);
  return horizon_bound(certify(motion, settings.problem.safe_set, error_budget(motion)));
}

TEST(Shield, lets_the_other_drive_where_its_plan_is_certified) {
  const auto car = dubins_car();
  const ControllerSettings settings = settings_beside(1.9);
  const Gaussian belief = small_belief();
  const Eigen::VectorXd seen = belief.mean;
  const auto shield = make_controller("shield", *car, settings);
  const auto alone = make_controller("nominal", *car, settings);
  EXPECT_EQ(shield->decide({.belief = belief, .observation = seen}).input,
            alone->decide({.belief = belief, .observation = seen}).input);
}

TEST(Shield, overrules_what_is_certified_above_the_limit) {
  const auto car = dubins_car();
  const ControllerSettings settings = settings_beside(0.45);
  const Gaussian belief = small_belief();
  const Eigen::VectorXd seen = belief.mean;
  const Situation situation{.belief = belief, .observation = seen};
  const auto alone = make_controller("nominal", *car, settings);
  const Decision& reckless = alone->decide(situation);
  const auto shield = make_controller("shield", *car, settings);
  const Decision& shielded = shield->decide(situation);
  EXPECT_NE(shielded.input, reckless.input);
  EXPECT_GT(plan_certificate(*car, settings, situation, reckless), 0.01);
  EXPECT_LE(plan_certificate(*car, settings, situation, shielded), 0.01);
  EXPECT_FALSE(shielded.risk_exceeded);
  EXPECT_EQ(shielded.policy->horizon(), reckless.policy->horizon());
}

TEST(Shield, says_where_no_plan_is_within_the_limit) {
  const auto car = dubins_car();
  const ControllerSettings settings = settings_beside(-0.5);  // inside the block
  const Gaussian belief = small_belief();
  const Eigen::VectorXd seen = belief.mean;
  const auto shield = make_controller("shield", *car, settings);
  const Decision& decision = shield->decide({.belief = belief, .observation = seen});
  EXPECT_TRUE(decision.risk_exceeded);
  EXPECT_EQ(decision.status, SolverStatus::kRiskExceeded);
}

TEST(Shield, wraps_every_other_controller_but_not_another_shield) {
  const auto car = dubins_car();
  ControllerSettings settings = settings_beside(1.9);
  const Gaussian belief = small_belief();
  const Eigen::VectorXd seen = belief.mean;
  for (const ControllerEntry& entry : controllers()) {
    settings.shield.of = entry.name;
    if (entry.name == "shield") {
      EXPECT_THROW((void)make_controller("shield", *car, settings), std::invalid_argument);
      continue;
    }
    SCOPED_TRACE(entry.name);
    const auto shield = make_controller("shield", *car, settings);
    EXPECT_TRUE(shield->decide({.belief = belief, .observation = seen}).input.allFinite());
  }
  settings.shield = {.of = "nominal", .limit = 0.0};
  EXPECT_THROW((void)make_controller("shield", *car, settings), std::invalid_argument);
}

}  // namespace shield_controller_test
}  // namespace qsmpc::controller
