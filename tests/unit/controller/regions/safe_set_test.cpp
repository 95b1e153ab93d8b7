#include "controller/regions/safe_set.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace safe_set_test {

using namespace testing;
// Differences of numbers of order one.
constexpr double kRounding = 1e-14;
// Grid spacing of a search. Next to the nearest point of a set of boxes, or of their complement,
// lies a whole grid cell that belongs to it, hence a grid point within the cell's diagonal.
constexpr double kSpacing = 0.02;
constexpr double kDiagonal = kSpacing * 1.41422;

SafeSet room_with_a_pillar() {
  return {
      .bounds = {.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(4.0, 3.0)},
      .obstacles = {Box{.lower = Eigen::Vector2d(2.0, 1.0), .upper = Eigen::Vector2d(3.0, 2.0)}}};
}

bool unsafe(const Eigen::Vector2d& point, const SafeSet& safe_set) {
  const auto in = [&](const Box& box) {
    return (point.array() >= box.lower.array()).all() && (point.array() <= box.upper.array()).all();
  };
  const auto strictly_in = [&](const Box& box) {
    return (point.array() > box.lower.array()).all() && (point.array() < box.upper.array()).all();
  };
  if (!strictly_in(safe_set.bounds)) return true;
  for (const Obstacle& each : safe_set.obstacles) {
    const Box& obstacle = *each.box();
    if (in(obstacle)) return true;
  }
  return false;
}

/// Distance from `point` to the nearest unsafe (or safe) point of a grid.
double searched_distance(const Eigen::Vector2d& point, const SafeSet& safe_set, bool to_unsafe,
                         double spacing) {
  double least = kInfinity;
  for (double x = -1.5; x <= 5.5; x += spacing) {
    for (double y = -1.5; y <= 4.5; y += spacing) {
      const Eigen::Vector2d candidate(x, y);
      if (unsafe(candidate, safe_set) != to_unsafe) continue;
      least = std::min(least, (candidate - point).norm());
    }
  }
  return least;
}

TEST(SafeSet, distance_to_unsafe_equals_a_search_over_the_plane) {
  Generator generator(31);
  const SafeSet room = room_with_a_pillar();
  int checked = 0;
  while (checked < 60) {
    const Eigen::Vector2d point(uniform(generator, 0.0, 4.0), uniform(generator, 0.0, 3.0));
    if (unsafe(point, room)) continue;
    const double found = searched_distance(point, room, true, kSpacing);
    EXPECT_NEAR(distance_to_unsafe(point, room), found, kDiagonal);
    EXPECT_EQ(clearance(point, room), distance_to_unsafe(point, room));
    ++checked;
  }
}

TEST(SafeSet, clearance_in_the_unsafe_set_is_minus_the_way_out) {
  Generator generator(32);
  const SafeSet room = room_with_a_pillar();
  int checked = 0;
  while (checked < 60) {
    const Eigen::Vector2d point(uniform(generator, -1.0, 5.0), uniform(generator, -1.0, 4.0));
    if (!unsafe(point, room)) continue;
    EXPECT_EQ(distance_to_unsafe(point, room), 0.0);
    EXPECT_NEAR(clearance(point, room), -searched_distance(point, room, false, kSpacing),
                kDiagonal);
    ++checked;
  }
}

TEST(SafeSet, clearances_of_many_points_are_those_of_each) {
  Generator generator(33);
  SafeSet room = room_with_a_pillar();
  room.bounds.upper[0] = kInfinity;
  for (const SafeSet& safe_set : {room_with_a_pillar(), room, unbounded_safe_set(2)}) {
    Points points(2, 203);
    for (double& x : points.reshaped()) x = uniform(generator, -2.0, 6.0);
    points.col(7) << 4.0, 1.5;    // on a wall
    points.col(100) << 2.0, 1.5;  // on the pillar
    const Eigen::VectorXd found = clearances(points, safe_set);
    ASSERT_EQ(found.size(), points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const double expected = clearance(points.col(i), safe_set);
      if (std::isinf(expected)) {
        EXPECT_EQ(found[i], expected);
      } else {
        EXPECT_NEAR(found[i], expected, kRounding) << points.col(i).transpose();
      }
      EXPECT_EQ(found[i] <= 0.0, expected <= 0.0);
    }
    for (const double broken : {std::nan(""), kInfinity, -kInfinity}) {
      for (const int axis : {0, 1}) {
        Points lost = points;
        lost(axis, 11) = broken;
        EXPECT_EQ(clearances(lost, safe_set)[11], -kInfinity);
        EXPECT_EQ(clearances(lost, safe_set)[12], found[12]);
      }
    }
  }
}

TEST(SafeSet, boundaries_count_as_unsafe) {
  const SafeSet room = room_with_a_pillar();
  for (const Eigen::Vector2d& point :
       {Eigen::Vector2d(0.0, 1.5), Eigen::Vector2d(4.0, 1.5), Eigen::Vector2d(1.0, 0.0),
        Eigen::Vector2d(1.0, 3.0), Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(2.0, 1.5),
        Eigen::Vector2d(2.5, 2.0), Eigen::Vector2d(3.0, 1.0)}) {
    EXPECT_EQ(distance_to_unsafe(point, room), 0.0) << point.transpose();
    EXPECT_LE(clearance(point, room), 0.0) << point.transpose();
  }
}

TEST(SafeSet, distance_to_a_box_is_to_its_nearest_point) {
  const Box box{.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(1.0, 2.0)};
  EXPECT_EQ(distance_to_box(Eigen::Vector2d(0.5, 0.5), box), 0.0);
  EXPECT_NEAR(distance_to_box(Eigen::Vector2d(4.0, 6.0), box), 5.0, kRounding);
  EXPECT_NEAR(distance_to_box(Eigen::Vector2d(-3.0, 1.0), box), 3.0, kRounding);
}

TEST(SafeSet, unrestricted_coordinates_do_not_count) {
  SafeSet corridor = unbounded_safe_set(3);
  EXPECT_EQ(distance_to_unsafe(Eigen::Vector3d(1e6, -4.0, 2.0), corridor), kInfinity);
  corridor.bounds.upper[1] = 1.0;
  corridor.obstacles.push_back(Box{.lower = Eigen::Vector3d(2.0, -kInfinity, -kInfinity),
                                   .upper = Eigen::Vector3d(3.0, kInfinity, kInfinity)});
  EXPECT_NEAR(distance_to_unsafe(Eigen::Vector3d(0.0, -7.0, 50.0), corridor), 2.0, kRounding);
  EXPECT_NEAR(distance_to_unsafe(Eigen::Vector3d(0.0, 0.5, 50.0), corridor), 0.5, kRounding);
  EXPECT_NEAR(clearance(Eigen::Vector3d(2.9, 0.5, 50.0), corridor), -0.1, kRounding);
}

TEST(SafeSet, invalid_boxes_are_refused) {
  SafeSet room = room_with_a_pillar();
  EXPECT_NO_THROW(check_safe_set(room));
  std::get<Box>(room.obstacles[0].form).upper[0] = 2.0;  // no interior
  EXPECT_THROW(check_safe_set(room), std::invalid_argument);
  room = room_with_a_pillar();
  room.bounds.lower[1] = std::nan("");
  EXPECT_THROW(check_safe_set(room), std::invalid_argument);
  room = room_with_a_pillar();
  std::get<Box>(room.obstacles[0].form).lower = Eigen::VectorXd::Zero(3);
  EXPECT_THROW(check_safe_set(room), std::invalid_argument);
  room = room_with_a_pillar();
  room.bounds.upper = Eigen::VectorXd::Ones(1);
  EXPECT_THROW(check_safe_set(room), std::invalid_argument);
}

}  // namespace safe_set_test
}  // namespace qsmpc::controller
