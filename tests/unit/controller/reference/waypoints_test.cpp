#include "controller/reference/waypoints.hpp"

#include <gtest/gtest.h>

#include "models/dynamics/dubins.hpp"

namespace qsmpc::controller {
namespace waypoints_test {

struct Corner {
  models::SystemDescription system = models::Dubins{.speed = 1.0, .time_step = 0.1}.description();
  Waypoints route{.states = Eigen::MatrixXd::Zero(3, 3), .radius = 0.5};

  Corner() {
    route.states.row(0) << 3.0, 3.0, 0.0;
    route.states.row(1) << 0.0, 4.0, 4.0;
  }

  [[nodiscard]] int passed(double x, double y, int before) const {
    return waypoints_passed(route, system, Eigen::Vector3d(x, y, 1.0), before);
  }
};

TEST(Waypoints, are_passed_in_turn_within_the_radius) {
  const Corner corner;
  EXPECT_EQ(corner.passed(0.0, 0.0, 0), 0);
  EXPECT_EQ(corner.passed(3.0, 4.0, 0), 0) << "the second is no way past the first";
  EXPECT_EQ(corner.passed(2.6, 0.2, 0), 1);
  EXPECT_EQ(corner.passed(9.0, 9.0, 1), 1) << "what was passed stays so";
  EXPECT_EQ(corner.passed(3.0, 3.4, 1), 1);
  EXPECT_EQ(corner.passed(3.0, 3.6, 1), 2);
  EXPECT_EQ(corner.passed(0.0, 4.0, 2), 2) << "the last is where the drive ends";
}

TEST(Waypoints, that_are_near_each_other_are_passed_at_once) {
  Corner corner;
  corner.route.radius = 4.5;
  EXPECT_EQ(corner.passed(3.0, 0.0, 0), 2);
}

TEST(Waypoints, way_leads_over_those_to_come) {
  const Corner corner;
  const Eigen::Vector3d at(0.0, 0.0, 0.0);
  EXPECT_NEAR(way_over(corner.route, corner.system, at, 0), 3.0 + 4.0 + 3.0, 1e-12);
  EXPECT_NEAR(way_over(corner.route, corner.system, at, 1), 5.0 + 3.0, 1e-12);
  EXPECT_NEAR(way_over(corner.route, corner.system, at, 2), 4.0, 1e-12);
  EXPECT_EQ(corner.route.next(1)[1], 4.0);
  EXPECT_EQ(corner.route.next(7)[0], 0.0) << "the last";
}

}  // namespace waypoints_test
}  // namespace qsmpc::controller
