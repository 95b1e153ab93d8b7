// A rectangle grown by a disc of the body: its corners are round.
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "controller/regions/planar/shape_region.hpp"
#include "controller/regions/shapes.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace grown_rectangle_test {

constexpr int kStage = 3;

/// A rectangle in the plane of the first two of three coordinates.
Box rectangle(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  return {.lower = Eigen::Vector3d(lower.x(), lower.y(), -kInfinity),
          .upper = Eigen::Vector3d(upper.x(), upper.y(), kInfinity)};
}

// Near a corner, bounds are those of the same rectangle as a shape, and far below those of the
// sharp corner.
TEST(GrownRectangle, bounds_near_a_corner_are_those_of_the_round_one) {
  constexpr double kRadius = 0.5;
  const Eigen::Vector2d lower(-1.0, -0.5);
  const Eigen::Vector2d upper(0.0, 0.0);
  const RegionPointer round =
      make_box(rectangle(lower, upper), {.radius = kRadius, .x = 0, .y = 1});
  const RegionPointer sharp =
      make_box(rectangle(lower.array() - kRadius, upper.array() + kRadius), {.x = 0, .y = 1});
  const RegionPointer shape =
      make_shape(TurnedBoxShape{.centre = 0.5 * (lower + upper), .size = upper - lower},
                 {.radius = kRadius, .x = 0, .y = 1});
  const Eigen::VectorXd error = Eigen::Vector3d::Constant(0.002);
  HigherNorms higher;
  higher.fill(error);
  const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
      [](const std::vector<Eigen::Index>& /*axes*/) -> Eigen::MatrixXd {
    return 4e-4 * Eigen::MatrixXd::Identity(3, 3);
  };
  // On the diagonal of each corner, 5 cm away from the round one and inside the sharp one.
  const double away = (kRadius + 0.05) / std::numbers::sqrt2;
  for (const double x : {lower.x() - away, upper.x() + away}) {
    for (const double y : {lower.y() - away, upper.y() + away}) {
      const Gaussian law{.mean = Eigen::Vector3d(x, y, 0.3),
                         .covariance = 4e-4 * Eigen::Matrix3d::Identity()};
      const auto bound_of = [&](const UnsafeRegion& region, WantedBounds wanted) {
        RegionProbability sum;
        region.add_probability(kStage,
                               {.law = law,
                                .error = error,
                                .higher = higher,
                                .smoothing = smoothing,
                                .wanted = wanted},
                               sum);
        return sum;
      };
      for (const WantedBounds wanted : {WantedBounds::kBoth, WantedBounds::kLeast}) {
        const RegionProbability bound = bound_of(*round, wanted);
        const RegionProbability same = bound_of(*shape, wanted);
        EXPECT_NEAR(bound.smooth, same.smooth, 1e-12);
        EXPECT_NEAR(bound.markov, same.markov, 1e-12);
        EXPECT_GT(bound_of(*sharp, wanted).smooth, 0.9);
        EXPECT_LT(bound.smooth, 0.03);
        // The mean is 2.5 deviations away from the tangent at the nearest point.
        EXPECT_GT(bound.smooth, 0.004);
      }
      TailSum tail;
      tail.clear(3);
      round->add_tail(kStage, law, tail);
      TailSum tail_of_shape;
      tail_of_shape.clear(3);
      shape->add_tail(kStage, law, tail_of_shape);
      EXPECT_NEAR(tail.value(), tail_of_shape.value(), 1e-12);
    }
  }
}

}  // namespace grown_rectangle_test
}  // namespace qsmpc::controller
