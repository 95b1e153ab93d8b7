#include "controller/reference/path_target.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "controller/planning/cost/placed_target.hpp"
#include "models/dynamics/bicycle.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {
namespace path_target_test {

using models::Bicycle;

std::shared_ptr<const ArcPath> circle(double radius) {
  Eigen::Matrix2Xd points(2, 48);
  for (int i = 0; i < 48; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 48;
    points.col(i) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return std::make_shared<const ArcPath>(points, true);
}

TEST(PathTarget, moves_at_its_speed_and_turns_without_a_jump) {
  const PathTarget target{.path = circle(10.0), .speed = SpeedProfile(4.0), .time_step = 0.5};
  const models::SystemDescription system = Bicycle{}.description();
  Eigen::VectorXd state = Eigen::VectorXd::Zero(6);
  state[Bicycle::kHeading] = 0.5 * std::numbers::pi + 4.0 * std::numbers::pi;  // two full turns
                                                                               // more
  Eigen::MatrixXd wanted(6, 60);
  path_targets(target, system, state, 0.0, wanted);
  for (Eigen::Index k = 0; k < wanted.cols(); ++k) {
    const double angle = 4.0 * 0.5 * static_cast<double>(k) / 10.0;
    EXPECT_NEAR(wanted(Bicycle::kX, k), 10.0 * std::cos(angle), 0.01);
    EXPECT_NEAR(wanted(Bicycle::kY, k), 10.0 * std::sin(angle), 0.01);
    EXPECT_NEAR(wanted(Bicycle::kHeading, k), state[Bicycle::kHeading] + angle, 0.01);
    EXPECT_EQ(wanted(Bicycle::kLongitudinalSpeed, k), 4.0);
    EXPECT_NEAR(wanted(Bicycle::kYawRate, k), 0.4, 1e-3);
    EXPECT_EQ(wanted(Bicycle::kLateralSpeed, k), 0.0);
  }
}

TEST(PathTarget, progress_is_counted_on_over_rounds) {
  const PathTarget target{.path = circle(10.0), .speed = SpeedProfile(4.0), .time_step = 0.1};
  double progress = 0.0;
  for (double truth = 0.0; truth < 3.2 * target.path->length(); truth += 0.4) {
    progress = progress_on(target, 1.05 * target.path->at(truth).position, progress);
    EXPECT_NEAR(progress, truth, 1e-4);  // the offset is not exactly perpendicular to the path
  }
}

TEST(SpeedProfile, keeps_the_accelerations_along_and_across) {
  // An ellipse: radii of 2.5 m at its ends, nearly straight sides.
  Eigen::Matrix2Xd points(2, 64);
  for (int i = 0; i < 64; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 64;
    points.col(i) << 40.0 * std::cos(angle), 10.0 * std::sin(angle);
  }
  const ArcPath path(points, true);
  const SpeedLimits limits{.along = 1.5, .across = 3.0, .top = 6.0};
  const SpeedProfile profile(path, limits);
  constexpr double kStep = 0.5;
  double least = 100.0;
  for (double along = 0.0; along < path.length(); along += kStep) {
    const double speed = profile.at(along);
    const double next = profile.at(along + kStep);
    least = std::min(least, speed);
    EXPECT_LE(speed, limits.top + 1e-12);
    // The profile is linear between the points; the curvature is not.
    EXPECT_LE(speed * speed * std::abs(path.at(along).curvature), 1.05 * limits.across);
    EXPECT_LE(std::abs(next * next - speed * speed) / (2.0 * kStep), 1.05 * limits.along);
  }
  EXPECT_NEAR(profile.top(), limits.top, 1e-12) << "on the straights";
  EXPECT_NEAR(least, std::sqrt(limits.across * 2.5), 0.1) << "in the bends";
}

TEST(SpeedProfile, of_one_speed_is_that_everywhere) {
  EXPECT_EQ(SpeedProfile(2.5).at(-3.0), 2.5);
  EXPECT_EQ(SpeedProfile(2.5).at(1e6), 2.5);
}

}  // namespace path_target_test
}  // namespace qsmpc::controller
