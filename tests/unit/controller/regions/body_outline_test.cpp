#include "controller/regions/body_outline.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace body_outline_test {

constexpr double kHalfTurn = std::numbers::pi;

double length_of(const std::vector<Arc>& arcs) {
  double length = 0.0;
  for (const Arc& arc : arcs) length += arc.radius * (arc.to - arc.from);
  return length;
}

TEST(BodyOutline, of_discs_that_do_not_meet_is_their_circles) {
  const Body body{.discs = {{.radius = 0.5}, {.radius = 0.25, .offset = {2.0, 0.0}}}};
  const std::vector<Arc> arcs = body_outline(body, {1.0, 1.0}, kHalfTurn / 2.0);
  ASSERT_EQ(arcs.size(), 2U);
  EXPECT_NEAR(length_of(arcs), 2.0 * kHalfTurn * 0.75, 1e-12);
  EXPECT_NEAR((arcs[1].centre - Eigen::Vector2d(1.0, 3.0)).norm(), 0.0, 1e-12);
}

TEST(BodyOutline, leaves_out_what_lies_in_another_disc) {
  // Two unit discs one unit apart: each has a third of its circle inside the other.
  const Body body{.discs = {{.radius = 1.0}, {.radius = 1.0, .offset = {1.0, 0.0}}}};
  const std::vector<Arc> arcs = body_outline(body, {0.0, 0.0}, 0.3);
  ASSERT_EQ(arcs.size(), 2U);
  EXPECT_NEAR(length_of(arcs), 2.0 * (2.0 / 3.0) * 2.0 * kHalfTurn, 1e-12);
  for (const Arc& arc : arcs) {
    for (const double share : {0.01, 0.5, 0.99}) {
      const double angle = arc.from + share * (arc.to - arc.from);
      const Eigen::Vector2d point =
          arc.centre + arc.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      for (const Arc& other : arcs) {
        EXPECT_GE((point - other.centre).norm(), other.radius - 1e-12);
      }
    }
  }
}

TEST(BodyOutline, shows_the_same_disc_once_and_a_covered_one_never) {
  const Body body{
      .discs = {{.radius = 0.5}, {.radius = 0.5}, {.radius = 0.1, .offset = {0.2, 0.1}}}};
  EXPECT_NEAR(length_of(body_outline(body, {0.0, 0.0}, 0.0)), kHalfTurn, 1e-12);
  EXPECT_TRUE(body_outline({}, {0.0, 0.0}, 0.0).empty());
}

}  // namespace body_outline_test
}  // namespace qsmpc::controller
