// Targets with a heading modulo 2π, by themselves and in plans.
#include "controller/planning/cost/angular_target.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace angular_target_test {

using namespace testing;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kHeading = 2;

TEST(AngularTarget, offset_of_an_angle_is_within_half_a_turn_and_whole_turns_away) {
  const Eigen::Vector3d target(1.0, -2.0, 0.5);
  for (double heading = -20.0; heading <= 20.0; heading += 0.37) {
    const Eigen::Vector3d state(4.0, 3.0, heading);
    const Eigen::VectorXd offset = target_offset(target, {kHeading}, state);
    EXPECT_EQ(offset[0], 3.0);
    EXPECT_EQ(offset[1], 5.0);
    EXPECT_LE(std::abs(offset[kHeading]), 0.5 * kTurn + 1e-14);
    const double turns = (heading - target[kHeading] - offset[kHeading]) / kTurn;
    EXPECT_NEAR(turns, std::round(turns), 1e-14);
  }
}

TEST(AngularTarget, nothing_changes_without_angles_or_within_half_a_turn) {
  const Eigen::Vector3d target(1.0, -2.0, 0.5);
  const Eigen::Vector3d far(40.0, 30.0, 20.0);
  EXPECT_EQ(target_offset(target, {}, far), far - target);
  const Eigen::Vector3d near(40.0, 30.0, 3.6);
  EXPECT_EQ(target_offset(target, {kHeading}, near), near - target);
}

/// A car whose cost includes the heading.
PlannerSettings heading_settings(std::vector<int> angles) {
  PlannerSettings settings = dubins_settings();
  settings.cost.state = Eigen::Vector3d(4.0, 4.0, 3.0).asDiagonal();
  settings.cost.terminal = settings.cost.state;
  settings.cost.target << 2.0, 1.0, 0.4;
  settings.cost.angles = std::move(angles);
  return settings;
}

/// The last of several plans along the path from the origin at this heading; all but the first are
/// warm starts.
struct Drive {
  double cost = 0.0;
  Eigen::MatrixXd inputs;
};

Drive drive(const PlannerSettings& settings, double heading, int plans = 3) {
  const auto car = dubins_car();
  Planner planner(*car, settings);
  Gaussian belief = dubins_belief();
  belief.mean[kHeading] = heading;
  Drive result;
  for (int step = 0; step < plans; ++step) {
    const Plan& plan = planner.plan(belief);
    result = {plan.cost.total(), plan.policy.inputs};
    belief.mean = plan.policy.states.col(1);
  }
  return result;
}

void expect_the_same_after_whole_turns(const PlannerSettings& settings, int plans) {
  const Drive plain = drive(settings, 0.1, plans);
  for (const double turns : {-1.0, 1.0, 3.0}) {
    const Drive turned = drive(settings, 0.1 + turns * kTurn, plans);
    // Rounding of the headings, about 1e-14, amplified by several iterations of a smooth problem.
    EXPECT_NEAR(turned.cost, plain.cost, 1e-11 * plain.cost);
    EXPECT_LE((turned.inputs - plain.inputs).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(AngularTarget, plans_do_not_depend_on_how_often_the_car_has_turned_round) {
  for (const bool closed_loop : {false, true}) {
    PlannerSettings settings = heading_settings({kHeading});
    settings.closed_loop = closed_loop;
    expect_the_same_after_whole_turns(settings, 3);
  }
}

TEST(AngularTarget, searches_for_valleys_do_not_depend_on_it_either) {
  PlannerSettings settings = heading_settings({kHeading});
  Box block = unbounded_safe_set(3).bounds;
  block.lower.head<2>() << 0.0, -1.5;
  block.upper.head<2>() << 2.0, -0.55;
  settings.safe_set.obstacles.push_back(block);
  // One plan only: later ones would be warm starts, which do not search.
  expect_the_same_after_whole_turns(settings, 1);
}

TEST(AngularTarget, whole_turns_count_in_plans_whose_target_names_no_angle) {
  const PlannerSettings settings = heading_settings({});
  const Drive plain = drive(settings, 0.1);
  const Drive turned = drive(settings, 0.1 + kTurn);
  EXPECT_GT(turned.cost, 2.0 * plain.cost);
  EXPECT_LT(turned.inputs.minCoeff(), -1.9);  // it unwinds
}

TEST(AngularTarget, car_turns_the_short_way_round) {
  PlannerSettings settings = heading_settings({kHeading});
  settings.cost.state = Eigen::Vector3d(0.0, 0.0, 3.0).asDiagonal();
  settings.cost.terminal = settings.cost.state;
  settings.cost.target << 0.0, 0.0, 3.0;
  settings.safe_set = unbounded_safe_set(3);
  EXPECT_LT(drive(settings, -3.0).inputs(0, 0), 0.0);
  settings.cost.angles.clear();
  EXPECT_GT(drive(settings, -3.0).inputs(0, 0), 1.9);
}

TEST(AngularTarget, prescribed_inputs_are_priced_about_the_nearest_target) {
  const auto car = dubins_car();
  const Eigen::MatrixXd inputs = Eigen::MatrixXd::Constant(1, 5, 0.3);
  Planner planner(*car, heading_settings({kHeading}));
  Gaussian belief = dubins_belief();
  const double plain = planner.prescribe(belief, inputs).cost.total();
  belief.mean[kHeading] = -kTurn;
  EXPECT_NEAR(planner.prescribe(belief, inputs).cost.total(), plain, 1e-12 * plain);
}

TEST(AngularTarget, settings_keep_the_target_as_it_was_given) {
  const auto car = dubins_car();
  Planner planner(*car, heading_settings({kHeading}));
  Gaussian belief = dubins_belief();
  belief.mean[kHeading] = 2.0 * kTurn;
  (void)planner.plan(belief);
  EXPECT_EQ(planner.settings().cost.target, Eigen::Vector3d(2.0, 1.0, 0.4));
}

TEST(AngularTarget, angles_that_are_not_states_are_refused) {
  const auto car = dubins_car();
  EXPECT_THROW(Planner(*car, heading_settings({3})), std::invalid_argument);
  EXPECT_THROW(Planner(*car, heading_settings({-1})), std::invalid_argument);
}

}  // namespace angular_target_test
}  // namespace qsmpc::controller
