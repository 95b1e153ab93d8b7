// The cheapest path around obstacles, and the plans' targets on it.
#include "controller/planning/guide/guide.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "controller/control/controller.hpp"
#include "controller/planning/guide/travel_field.hpp"
#include "models/constants.hpp"
#include "models/dynamics/dubins.hpp"

namespace qsmpc::controller {
namespace guide_test {

// Error of first-order fast marching and of paths along grid nodes.
constexpr double kFieldTolerance = 0.06;

PlaneGrid ten_metres() {
  return {.origin = {0.0, 0.0}, .spacing = 0.1, .columns = 101, .rows = 101};
}

TEST(TravelField, a_metre_costs_its_price) {
  const TravelField field(ten_metres(), Eigen::ArrayXXd::Constant(101, 101, 3.0), {5.0, 5.0});
  for (const Eigen::Vector2d& from :
       {Eigen::Vector2d(0.0, 5.0), Eigen::Vector2d(9.03, 8.47), Eigen::Vector2d(2.0, 9.99)}) {
    const double expected = 3.0 * (from - Eigen::Vector2d(5.0, 5.0)).norm();
    EXPECT_NEAR(field.cost(from), expected, kFieldTolerance * expected);
    EXPECT_NEAR(field.cost_of_line(from, {5.0, 5.0}, kInfinity), expected, 1e-9);
  }
}

TEST(TravelField, the_way_leads_through_the_door_of_a_dear_wall) {
  Eigen::ArrayXXd prices = Eigen::ArrayXXd::Ones(101, 101);
  prices.middleRows(48, 5).setConstant(1000.0);  // x from 4.8 to 5.2 …
  prices.block(48, 90, 5, 8).setConstant(1.0);   // … but for y from 9.0 to 9.7
  const TravelField field(ten_metres(), prices, {9.0, 1.0});
  std::vector<Eigen::Vector2d> way;
  field.trace({1.0, 1.0}, way);
  double before = kInfinity;
  for (const Eigen::Vector2d& node : way) {
    EXPECT_LT(field.cost(node), before);
    before = field.cost(node);
    if (node.x() >= 4.75 && node.x() <= 5.25) {
      EXPECT_GE(node.y(), 8.95);
      EXPECT_LE(node.y(), 9.75);
    }
  }
  const double shortest = 2.0 * std::hypot(3.8, 8.0) + 0.4;
  EXPECT_NEAR(field.cost({1.0, 1.0}), shortest, kFieldTolerance * shortest);
  EXPECT_GT(field.cost_of_line({1.0, 1.0}, {9.0, 1.0}, kInfinity), 100.0);
}

TEST(TravelField, refuses_invalid_prices) {
  EXPECT_THROW(TravelField(ten_metres(), Eigen::ArrayXXd::Zero(101, 101), {1.0, 1.0}),
               std::invalid_argument);
  EXPECT_THROW(TravelField(ten_metres(), Eigen::ArrayXXd::Ones(101, 100), {1.0, 1.0}),
               std::invalid_argument);
}

Box box(double x0, double x1, double y0, double y1) {
  return {.lower = Eigen::Vector3d(x0, y0, -kInfinity),
          .upper = Eigen::Vector3d(x1, y1, kInfinity)};
}

std::unique_ptr<const models::Dynamics> car() {
  return models::make_dynamics("dubins", {{"speed", 1.0}}, 0.1);
}

/// From (1, 5) to (9, 5) past a pocket that opens towards the start.
PlannerSettings pocket() {
  PlannerSettings settings;
  settings.horizon = 12;
  settings.state_points = 20;
  settings.noise_points = 10;
  settings.compressed_points = 20;
  settings.noise_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  settings.cost = {.state = Eigen::Vector3d(60.0, 60.0, 1.0).asDiagonal(),
                   .input = Eigen::MatrixXd::Constant(1, 1, 2.0),
                   .terminal = Eigen::Vector3d(60.0, 60.0, 5.0).asDiagonal(),
                   .target = Eigen::Vector3d(9.0, 5.0, 0.0)};
  settings.safe_set = {
      .bounds = box(0.0, 10.0, 0.0, 10.0),
      .obstacles = {box(6.0, 6.5, 3.0, 7.0), box(4.0, 6.0, 6.5, 7.0), box(4.0, 6.0, 3.0, 3.5)},
      .body = {.discs = {}, .x = 0, .y = 1, .heading = 2}};
  settings.penalty = {.box = 2000.0, .obstacle = 2000.0, .length = 0.3};
  settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                     .upper = Eigen::VectorXd::Constant(1, 2.0)};
  return settings;
}

TEST(Guide, aims_at_the_target_where_it_is_in_sight) {
  const auto dynamics = car();
  const PlannerSettings settings = pocket();
  Guide guide(*dynamics, settings);
  const Eigen::Vector3d state(8.0, 6.0, 0.3);
  const Aim& aim = guide.aim(state);
  EXPECT_EQ(aim.state, settings.cost.target);
  EXPECT_NEAR(aim.way, std::sqrt(2.0), 0.15);
}

TEST(Guide, aims_beside_what_hides_the_target) {
  const auto dynamics = car();
  Guide guide(*dynamics, pocket());
  // Two full turns further, with the same meaning.
  const double turns = 4.0 * std::numbers::pi;
  const Aim& aim = guide.aim(Eigen::Vector3d(1.0, 5.2, turns));
  EXPECT_GT(std::abs(aim.state[1] - 5.0), 1.9);
  EXPECT_LT(aim.state[0], 6.6);
  EXPECT_NEAR(aim.state[2], turns, std::numbers::pi);
  EXPECT_GT(aim.way, 8.5);
  EXPECT_LT(aim.way, 11.0);
}

TEST(Guide, points_along_the_way_whatever_the_heading_of_the_state) {
  const auto dynamics = car();
  Guide guide(*dynamics, pocket());
  const double along = guide.aim(Eigen::Vector3d(1.0, 5.2, 0.0)).state[2];
  for (double heading = -7.0; heading < 7.0; heading += 0.5) {
    const double aimed = guide.aim(Eigen::Vector3d(1.0, 5.2, heading)).state[2];
    EXPECT_NEAR(std::remainder(aimed - along, 2.0 * std::numbers::pi), 0.0, 1e-12) << heading;
    EXPECT_LE(std::abs(aimed - heading), std::numbers::pi + 1e-12) << heading;
  }
}

TEST(Guide, passes_a_gap_only_where_the_noise_leaves_room_for_it) {
  const auto dynamics = car();
  PlannerSettings settings = pocket();
  // A wall with a 1 m gap on the straight line, and an open end above.
  settings.safe_set.obstacles = {box(4.0, 4.5, 0.0, 4.5), box(4.0, 4.5, 5.5, 8.0)};
  settings.risk.plan = 0.02;
  Guide calm(*dynamics, settings);
  EXPECT_LT(calm.aim(Eigen::Vector3d(1.0, 5.0, 0.0)).way, 8.5);
  settings.noise_covariance = Eigen::Vector3d(0.02, 0.02, 0.001).asDiagonal();
  Guide rough(*dynamics, settings);
  EXPECT_GT(lateral_deviation(*dynamics, settings), 0.15);
  EXPECT_GT(rough.aim(Eigen::Vector3d(1.0, 5.0, 0.0)).way, 9.5);
  // A body wider than the gap must go around as well.
  settings.noise_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  settings.safe_set.body.discs = {{.radius = 0.55, .offset = Eigen::Vector2d::Zero()}};
  Guide wide(*dynamics, settings);
  EXPECT_GT(wide.aim(Eigen::Vector3d(1.0, 5.0, 0.0)).way, 9.5);
}

TEST(Guide, needs_a_plane_with_finite_bounds) {
  const auto dynamics = car();
  PlannerSettings settings = pocket();
  settings.safe_set.bounds.upper[1] = kInfinity;
  EXPECT_THROW(Guide(*dynamics, settings), std::invalid_argument);
}

/// How close a noise-free drive of 200 periods comes to the target.
double nearest_approach(const char* kind, const models::Dynamics& dynamics,
                        const PlannerSettings& settings) {
  const auto controller = make_controller(kind, dynamics, {.problem = settings});
  Gaussian belief{.mean = Eigen::Vector3d(1.0, 5.0, 0.0),
                  .covariance = 1e-4 * Eigen::Matrix3d::Identity()};
  double nearest = kInfinity;
  for (int period = 0; period < 200; ++period) {
    const Decision& decision =
        controller->decide({.period = period, .belief = belief, .observation = belief.mean});
    models::StateBatch next(3, 1);
    dynamics.step(models::StateBatch(belief.mean), models::StateBatch(decision.input), next);
    belief.mean = next.col(0);
    nearest = std::min(nearest, (belief.mean - settings.cost.target).head<2>().norm());
  }
  return nearest;
}

TEST(Guide, leads_out_of_a_pocket_that_plans_are_caught_in) {
  const auto dynamics = car();
  for (const char* kind : {"quantised", "tube", "mppi"}) {
    SCOPED_TRACE(kind);
    PlannerSettings settings = pocket();
    EXPECT_GT(nearest_approach(kind, *dynamics, settings), 2.0);
    settings.guide = true;
    EXPECT_LT(nearest_approach(kind, *dynamics, settings), 0.5);
  }
}

}  // namespace guide_test
}  // namespace qsmpc::controller
