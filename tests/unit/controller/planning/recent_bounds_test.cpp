// The surrogate bounds of recent policies: those of a new computation, which is made only for
// another policy or belief.
#include "controller/planning/risk/recent_bounds.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "models/motion/obstacle_motion.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace recent_bounds_test {

using namespace testing;

constexpr int kHorizon = 4;

/// A car that drives towards a block, and the bounds of its policies; the stages computed are
/// counted.
class RecentBoundsTest : public ::testing::Test {
 protected:
  Policy policy_with(double yaw_rate) {
    Policy policy;
    policy.inputs = Eigen::MatrixXd::Constant(1, kHorizon, yaw_rate);
    policy.states = nominal_states(*car_, belief_.mean, policy.inputs);
    policy.gains.assign(kHorizon, Eigen::RowVector3d(0.0, -0.5, -0.5));
    policy.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                     .upper = Eigen::VectorXd::Constant(1, 2.0)};
    return policy;
  }

  PredictedMotion motion_of(const Gaussian& belief, const Policy& policy) {
    return {.dynamics = *car_,
            .noise_covariance = noise_,
            .belief = belief,
            .policy = policy,
            .prediction = none_};
  }

  /// Whether these bounds had to be computed, after a comparison with the right ones.
  bool computes(const Gaussian& belief, const Policy& policy) {
    const PredictedMotion motion = motion_of(belief, policy);
    const SurrogateBounds expected = surrogate_bounds(motion, unsafe_, CertificateEffort::kLeast,
                                                      run_in_turn, NarrowCore::kIfTelling);
    const int before = loops_;
    const SurrogateBounds& bounds = recent_.of(motion);
    EXPECT_EQ(bounds.bounds.size(), expected.bounds.size());
    for (int k = 0; k < kHorizon; ++k) {
      EXPECT_EQ(bounds.bounds[k].markov, expected.bounds[k].markov);
      EXPECT_EQ(bounds.bounds[k].smooth, expected.bounds[k].smooth);
      EXPECT_EQ(bounds.surrogates[k + 1].law.mean, expected.surrogates[k + 1].law.mean);
    }
    return loops_ > before;
  }
  bool computes(double yaw_rate) { return computes(belief_, policy_with(yaw_rate)); }

  std::unique_ptr<const models::Dynamics> car_ = dubins_car();
  Eigen::MatrixXd noise_ = 1e-3 * Eigen::MatrixXd::Identity(3, 3);
  Gaussian belief_ = {.mean = Eigen::Vector3d::Zero(),
                      .covariance = 1e-3 * Eigen::Matrix3d::Identity()};
  Prediction none_;
  UnsafeSet unsafe_{block_settings().safe_set};
  int loops_ = 0;
  Executor run_ = [this](int count, TaskRef task) {
    ++loops_;
    run_in_turn(count, task);
  };
  RecentBounds recent_{unsafe_, run_};
};

TEST_F(RecentBoundsTest, are_computed_once) {
  EXPECT_TRUE(computes(0.1));
  EXPECT_FALSE(computes(0.1));
  EXPECT_TRUE(computes(0.2));
  EXPECT_FALSE(computes(0.1));
  EXPECT_FALSE(computes(0.2));
}

TEST_F(RecentBoundsTest, are_those_of_the_policy_and_the_belief) {
  const Policy policy = policy_with(0.1);
  EXPECT_TRUE(computes(belief_, policy));
  Policy other = policy;
  other.gains[kHorizon - 1](0, 2) = -0.6;
  EXPECT_TRUE(computes(belief_, other));
  other = policy;
  other.inputs(0, kHorizon - 1) = 0.2;
  EXPECT_TRUE(computes(belief_, other));
  other = policy;
  other.states(1, 0) = 0.05;
  EXPECT_TRUE(computes(belief_, other));
  Gaussian wider = belief_;
  wider.covariance *= 2.0;
  EXPECT_TRUE(computes(wider, policy));
  Gaussian beside = belief_;
  beside.mean.y() = 0.1;
  EXPECT_TRUE(computes(beside, policy));
  EXPECT_FALSE(computes(belief_, policy));
}

TEST_F(RecentBoundsTest, of_the_policy_used_least_recently_are_dropped) {
  EXPECT_TRUE(computes(0.1));
  EXPECT_TRUE(computes(0.2));
  EXPECT_FALSE(computes(0.1));
  for (const double other : {0.3, 0.4, 0.5, 0.6, 0.7}) EXPECT_TRUE(computes(other));
  EXPECT_FALSE(computes(0.1));
  EXPECT_TRUE(computes(0.2));
}

TEST_F(RecentBoundsTest, are_forgotten_when_asked) {
  EXPECT_TRUE(computes(0.1));
  recent_.forget();
  EXPECT_TRUE(computes(0.1));
}

TEST(RecentBoundsOfAPlanner, follow_the_forecast_of_a_moving_obstacle) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.noise_covariance = 1e-3 * Eigen::Matrix3d::Identity();
  settings.risk.plan = 0.1;
  settings.safe_set.bounds.lower.head<2>().setConstant(-12.0);
  settings.safe_set.body = {.discs = {{.radius = 0.1}}, .x = 0, .y = 1, .heading = 2};
  Obstacle disc = PlanarShape(DiscShape{.centre = {0.6, 0.0}, .radius = 0.2});
  disc.motion.emplace();
  settings.safe_set.obstacles = {disc};
  const auto forecast = std::make_shared<ObstacleForecast>(1);
  settings.safe_set.forecast = forecast;
  Planner planner(*car, settings);
  const Gaussian belief = {.mean = Eigen::Vector3d::Zero(),
                           .covariance = 1e-3 * Eigen::Matrix3d::Identity()};
  const Eigen::MatrixXd ahead = Eigen::MatrixXd::Zero(1, settings.horizon);
  EXPECT_GT(planner.prescribe(belief, ahead).risk.plan, 0.5);
  forecast->set(0, {{ObstaclePlace{.offset = {0.0, 5.0}}}});
  EXPECT_LT(planner.prescribe(belief, ahead).risk.plan, 0.01);
}

}  // namespace recent_bounds_test
}  // namespace qsmpc::controller
