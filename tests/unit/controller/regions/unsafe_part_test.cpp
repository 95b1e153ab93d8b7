#include "controller/regions/unsafe_part.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace unsafe_part_test {

/// An obstacle that extends through the upper bound of y.
UnsafeSet room_with_a_column() {
  return SafeSet{
      .bounds = {.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(4.0, 3.0)},
      .obstacles = {Box{.lower = Eigen::Vector2d(2.0, 1.0), .upper = Eigen::Vector2d(3.0, 5.0)}}};
}

UnsafePart part_at(double x, double y) {
  return unsafe_part(Eigen::Vector2d(x, y), room_with_a_column());
}

TEST(UnsafePart, is_the_obstacle_or_the_bounds_and_neither_where_it_is_safe) {
  EXPECT_EQ(part_at(1.0, 1.0), UnsafePart::kNone);
  EXPECT_EQ(part_at(2.5, 2.0), UnsafePart::kObstacle);
  EXPECT_EQ(part_at(5.0, 1.0), UnsafePart::kBounds);
}

TEST(UnsafePart, of_both_at_once_is_the_obstacle) {
  EXPECT_EQ(part_at(2.5, 4.0), UnsafePart::kObstacle);
  EXPECT_EQ(part_at(2.5, 3.0), UnsafePart::kObstacle);
}

TEST(UnsafePart, touching_is_unsafe) {
  EXPECT_EQ(part_at(2.0, 2.0), UnsafePart::kObstacle);
  EXPECT_EQ(part_at(0.0, 1.0), UnsafePart::kBounds);
}

TEST(UnsafePart, is_none_exactly_where_the_clearance_is_positive) {
  const UnsafeSet unsafe = room_with_a_column();
  for (double x = -0.5; x <= 4.5; x += 0.25) {
    for (double y = -0.5; y <= 5.5; y += 0.25) {
      const Eigen::Vector2d point(x, y);
      EXPECT_EQ(unsafe_part(point, unsafe) == UnsafePart::kNone, clearance(point, unsafe) > 0.0)
          << x << ", " << y;
    }
  }
}

}  // namespace unsafe_part_test
}  // namespace qsmpc::controller
