#include "controller/regions/unsafe_weight.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace unsafe_weight_test {

/// An obstacle that extends through the upper bound of y.
UnsafeSet room() {
  return SafeSet{
      .bounds = {.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(4.0, 3.0)},
      .obstacles = {Box{.lower = Eigen::Vector2d(2.0, 1.0), .upper = Eigen::Vector2d(3.0, 5.0)}}};
}

TEST(UnsafeWeight, is_that_of_the_points_that_touch_the_unsafe_set) {
  DiscreteMeasure measure{.locations = Points(2, 5), .weights = Eigen::VectorXd(5)};
  measure.locations << 1.0, 2.5, 2.0, 5.0, std::nan(""),  //
      1.0, 2.0, 2.0, 1.0, 1.0;
  measure.weights << 0.5, 0.25, 0.125, 0.0625, 0.0625;
  UnsafeWeightScratch scratch;
  EXPECT_EQ(unsafe_weight(measure, room(), 1, scratch), 0.5);
}

TEST(UnsafeWeight, is_of_the_body_and_not_of_its_position) {
  SafeSet empty{.bounds = {.lower = Eigen::Vector2d(0.0, 0.0), .upper = Eigen::Vector2d(4.0, 3.0)},
                .obstacles = {}};
  const DiscreteMeasure measure{.locations = Points{{1.0, 2.0}, {0.5, 1.5}},
                                .weights = Eigen::Vector2d(0.25, 0.75)};
  UnsafeWeightScratch scratch;
  EXPECT_EQ(unsafe_weight(measure, empty, 1, scratch), 0.0);
  empty.body = {.discs = {{.radius = 0.5}}, .x = 0, .y = 1};
  EXPECT_EQ(unsafe_weight(measure, empty, 1, scratch), 0.25);
}

}  // namespace unsafe_weight_test
}  // namespace qsmpc::controller
