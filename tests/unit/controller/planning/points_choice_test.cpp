// The number of points that a planner needs, judged by the costs of its plans on simulated paths.
#include "controller/planning/points_choice.hpp"

#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/planner.hpp"
#include "tests/support/planning_quality.hpp"
#include "tests/support/policy_search.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace points_choice_test {

using namespace testing;

/// A car close to a block with an almost unknown heading: few points capture little of the effect
/// of a turn.
PlannerSettings uncertain_settings() {
  PlannerSettings settings = block_settings();
  settings.state_points = 100;
  settings.noise_points = 100;
  settings.compressed_points = 100;
  settings.max_evaluations = 300;
  return settings;
}

Gaussian uncertain_belief() {
  return {.mean = Eigen::Vector3d::Zero(),
          .covariance = Eigen::Vector3d(0.02, 0.02, 0.5).asDiagonal()};
}

TEST(PointsChoice, asks_for_more_where_less_may_be_lost) {
  const auto car = dubins_car();
  const auto chosen = [&](double tolerance) {
    return choose_points(*car, uncertain_belief(), {.tolerance = tolerance, .stretches = 3},
                         uncertain_settings());
  };
  const PointsChoice wide = chosen(0.1);
  const PointsChoice narrow = chosen(1e-4);
  EXPECT_LT(wide.state_points, narrow.state_points);
  EXPECT_LT(wide.compressed_points, narrow.compressed_points);
  EXPECT_LE(wide.gap, 0.1);
  EXPECT_LE(narrow.gap, 1e-4);
  EXPECT_EQ(wide.places, 6);
}

TEST(PointsChoice, leaves_all_points_where_no_fewer_will_do) {
  const auto car = dubins_car();
  PlannerSettings settings = uncertain_settings();
  settings.state_points = 20;
  settings.compressed_points = 15;
  const PointsChoice all = choose_points(*car, uncertain_belief(), {.tolerance = 1e-300}, settings);
  EXPECT_EQ(all.state_points, 20);
  EXPECT_EQ(all.compressed_points, 15);
  EXPECT_EQ(all.gap, 0.0);
}

TEST(PointsChoice, plans_with_the_points_cost_what_those_with_all_of_them_do_on_simulated_paths) {
  constexpr double kTolerance = 1e-3;
  const auto car = default_car();
  const PlannerSettings all = blocks_settings(8);
  const std::vector<Place> places = places_among_blocks();
  const PointsChoice choice =
      choose_points(*car, places.front().belief, {.tolerance = kTolerance}, all);
  ASSERT_LT(choice.compressed_points, all.compressed_points);
  PlannerSettings fewer = all;
  choice.apply_to(fewer);
  for (const Place& place : places) {
    // Both meet the same noise, and minimise the price except for what their points do not resolve:
    // half a tolerance exceeds the error of the difference over 20,000 paths.
    SampledProblem paths(*car, all, place.belief, {.paths = 20000, .seed = 5});
    const double with_all = paths.evaluate(Planner(*car, all).plan(place.belief).policy);
    const double with_fewer = paths.evaluate(Planner(*car, fewer).plan(place.belief).policy);
    EXPECT_LE(with_fewer, (1.0 + 1.5 * kTolerance) * with_all) << place.name;
  }
}

TEST(PointsChoice, plans_within_a_limit_keep_it_by_all_points) {
  const auto car = dubins_car();
  PlannerSettings all = uncertain_settings();
  all.penalty.box = 0.0;
  all.penalty.obstacle = 0.0;
  all.noise_covariance = Eigen::Vector3d(2e-3, 2e-3, 1e-3).asDiagonal();
  all.risk.plan = 0.02;
  all.safe_set.obstacles = {
      Box{.lower = Eigen::Vector3d(1.2, -0.3, -1e9), .upper = Eigen::Vector3d(1.5, 0.35, 1e9)}};
  const Gaussian belief{.mean = Eigen::Vector3d::Zero(),
                        .covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-3).asDiagonal()};
  const PointsChoice choice = choose_points(*car, belief, {.stretches = 2}, all);
  PlannerSettings fewer = all;
  choice.apply_to(fewer);
  Planner planner(*car, fewer);
  const Plan& plan = planner.plan(belief);
  ASSERT_TRUE(plan.risk.kept);
  EXPECT_TRUE(Planner(*car, all).price(belief, plan).risk.kept);
}

TEST(PointsChoice, depends_on_nothing_but_what_is_given) {
  const auto car = dubins_car();
  PlannerSettings hurried = uncertain_settings();
  hurried.deadline = 1e-9;
  const PointsSearch search{.tolerance = 0.01, .stretches = 2};
  const PointsChoice one = choose_points(*car, uncertain_belief(), search, uncertain_settings());
  const PointsChoice other = choose_points(*car, uncertain_belief(), search, hurried);
  EXPECT_EQ(one.state_points, other.state_points);
  EXPECT_EQ(one.compressed_points, other.compressed_points);
  EXPECT_EQ(one.gap, other.gap);
}

/// A puck that starts at its target.
PlannerSettings resting_settings() {
  PlannerSettings settings;
  settings.horizon = 5;
  settings.noise_covariance = 0.01 * Eigen::Matrix4d::Identity();
  settings.cost = {.state = Eigen::Matrix4d::Identity(),
                   .input = Eigen::Matrix2d::Identity(),
                   .terminal = Eigen::Matrix4d::Identity(),
                   .target = Eigen::Vector4d::Zero()};
  settings.safe_set = unbounded_safe_set(4);
  settings.bounds = {.lower = Eigen::Vector2d::Constant(-5.0),
                     .upper = Eigen::Vector2d::Constant(5.0)};
  return settings;
}

TEST(PointsChoice, ends_where_plans_stay_where_they_are) {
  const auto puck = models::make_dynamics("point_mass", {}, 0.1);
  const PlannerSettings settings = resting_settings();
  const PointsChoice choice = choose_points(
      *puck, {.mean = Eigen::Vector4d::Zero(), .covariance = settings.noise_covariance}, {},
      settings);
  EXPECT_EQ(choice.places, 1);
}

TEST(PointsChoice, keeps_all_points_where_no_plan_can_be_compared) {
  FragileCar car;
  car.broken = true;
  const PointsChoice all = choose_points(car, dubins_belief(), {}, dubins_settings());
  EXPECT_EQ(all.places, 0);
  EXPECT_EQ(all.state_points, dubins_settings().state_points);
  EXPECT_EQ(all.compressed_points, dubins_settings().compressed_points);
  EXPECT_EQ(all.gap, 0.0);
}

TEST(PointsChoice, continues_to_the_next_waypoint) {
  // A way back over the first waypoint, where a search that knows no other would end.
  const auto puck = models::make_dynamics("point_mass", {}, 0.1);
  PlannerSettings settings = resting_settings();
  settings.horizon = 20;
  settings.cost.state *= 100.0;
  settings.cost.terminal *= 100.0;
  Waypoints route;
  route.states = Eigen::MatrixXd::Zero(4, 2);
  route.states.row(0) << 2.0, -4.0;
  route.radius = 0.5;
  const Gaussian start{.mean = Eigen::Vector4d::Zero(), .covariance = settings.noise_covariance};
  const auto places = [&](const Waypoints& waypoints) {
    PlannerSettings with = settings;
    with.waypoints = waypoints;
    with.cost.target = waypoints.states.rightCols<1>();
    return choose_points(*puck, start, {.stretches = 8}, with).places;
  };
  Waypoints first_alone = route;
  first_alone.states = route.states.leftCols<1>().eval();
  EXPECT_GT(places(route), places(first_alone));
}

TEST(PointsChoice, refuses_a_search_for_nothing) {
  const auto car = dubins_car();
  for (const PointsSearch& search :
       {PointsSearch{.tolerance = 0.0}, PointsSearch{.tolerance = -1.0},
        PointsSearch{.tolerance = std::numeric_limits<double>::quiet_NaN()},
        PointsSearch{.stretches = 0}}) {
    EXPECT_THROW((void)choose_points(*car, uncertain_belief(), search, uncertain_settings()),
                 std::invalid_argument);
  }
}

}  // namespace points_choice_test
}  // namespace qsmpc::controller
