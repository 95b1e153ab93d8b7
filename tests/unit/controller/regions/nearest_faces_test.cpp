// Signed distances and their derivatives, for every shape and for the body.
#include <cmath>

#include <gtest/gtest.h>

#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::controller {
namespace nearest_faces_test {

/// A room with two blocks, one of them forbidden only for certain speeds, and a long vehicle.
SafeSet room() {
  SafeSet room = unbounded_safe_set(4);  // x, y, heading, speed
  room.bounds.lower.head<2>().setConstant(-3.0);
  room.bounds.upper.head<2>().setConstant(4.0);
  room.bounds.upper[3] = 2.5;
  Box block = unbounded_safe_set(4).bounds;
  block.lower.head<2>() = Eigen::Vector2d(0.5, -0.4);
  block.upper.head<2>() = Eigen::Vector2d(1.5, 0.7);
  room.obstacles.push_back(block);
  block.lower.head<2>() = Eigen::Vector2d(-2.0, 1.0);
  block.upper.head<2>() = Eigen::Vector2d(-1.0, 3.0);
  block.lower[3] = 1.0;
  block.upper[3] = 2.0;
  room.obstacles.push_back(block);
  room.body = {
      .discs = {{.radius = 0.3, .offset = {0.0, 0.0}}, {.radius = 0.2, .offset = {0.5, 0.1}}},
      .x = 0,
      .y = 1,
      .heading = 2};
  return room;
}

Points random_states(Eigen::Index count) {
  const Eigen::VectorXd u = models::uniform_sample(4 * count, {.seed = 3});
  Points states = u.reshaped(4, count);
  states.topRows(2) = (8.0 * states.topRows(2).array() - 3.5).matrix();
  states.row(2) = (6.0 * states.row(2).array() - 3.0).matrix();
  states.row(3) = (3.0 * states.row(3).array()).matrix();
  return states;
}

TEST(NearestFaces, are_at_the_distances_of_every_region) {
  const UnsafeSet unsafe(room());
  const Points states = random_states(400);
  for (const DiscView& disc : unsafe.discs()) {
    for (const RegionPointer& region : disc.regions) {
      NearestFaces nearest{.distance = Eigen::ArrayXd::Constant(400, kInfinity),
                           .slope = Points::Zero(4, 400)};
      region->lower_to_faces(0, states, nearest);
      for (Eigen::Index i = 0; i < states.cols(); ++i) {
        EXPECT_NEAR(nearest.distance[i], region->signed_distance(0, states.col(i)), 1e-12);
        EXPECT_NEAR(nearest.slope.col(i).norm(), 1.0, 1e-12);
      }
    }
  }
}

TEST(NearestFaces, clearances_have_the_derivatives_of_differences) {
  const UnsafeSet unsafe(room());
  const Points states = random_states(400);
  ClearanceScratch scratch;
  NearestFaces nearest;
  clearances_with_slopes(states, unsafe, 0, scratch, nearest);
  int kinks = 0;
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    EXPECT_NEAR(nearest.distance[i], clearance(states.col(i), unsafe), 1e-12);
    Eigen::VectorXd slope(4);
    for (int a = 0; a < 4; ++a) {
      Eigen::VectorXd up = states.col(i);
      Eigen::VectorXd down = states.col(i);
      up[a] += 1e-6;
      down[a] -= 1e-6;
      slope[a] = (clearance(up, unsafe) - clearance(down, unsafe)) / 2e-6;
    }
    // There is no derivative where two faces are equally near.
    if ((slope - nearest.slope.col(i)).norm() > 1e-5) ++kinks;
  }
  EXPECT_LE(kinks, 2);
}

TEST(NearestFaces, lower_only_what_is_farther) {
  const UnsafeSet unsafe(room());
  const Points states = random_states(5);
  NearestFaces nearest{.distance = Eigen::ArrayXd::Constant(5, -100.0),
                       .slope = Points::Constant(4, 5, 7.0)};
  for (const RegionPointer& region : unsafe.discs().front().regions) {
    region->lower_to_faces(0, states, nearest);
  }
  EXPECT_TRUE((nearest.distance == -100.0).all());
  EXPECT_TRUE((nearest.slope.array() == 7.0).all());
}

TEST(NearestFaces, nothing_unsafe_is_infinitely_far_away) {
  const UnsafeSet unsafe(unbounded_safe_set(4));
  ClearanceScratch scratch;
  NearestFaces nearest;
  clearances_with_slopes(random_states(3), unsafe, 0, scratch, nearest);
  EXPECT_TRUE((nearest.distance == kInfinity).all());
  EXPECT_TRUE(nearest.slope.isZero(0.0));
}

}  // namespace nearest_faces_test
}  // namespace qsmpc::controller
