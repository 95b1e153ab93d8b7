// The body: clearances compared with a search over its points, placements and their derivatives,
// and bodies without room.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/certification/smoothed_bound.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace body_test {

using namespace testing;

/// A room with a block, for states (x, y, heading, speed), with a limited speed as well.
SafeSet room(const Body& body) {
  SafeSet set = unbounded_safe_set(4);
  set.bounds.lower.head(2) << -1.0, -1.0;
  set.bounds.upper.head(2) << 5.0, 4.0;
  set.bounds.upper[3] = 2.0;
  Box block = unbounded_safe_set(4).bounds;
  block.lower.head(2) << 2.0, 1.0;
  block.upper.head(2) << 3.0, 2.0;
  set.obstacles = {block};
  set.body = body;
  return set;
}

Body car() {
  return {.discs = {{.radius = 0.2, .offset = {0.3, 0.0}},
                    {.radius = 0.25, .offset = {-0.2, 0.1}},
                    {.radius = 0.1, .offset = {0.0, 0.0}}},
          .x = 0,
          .y = 1,
          .heading = 2};
}

Eigen::Vector4d random_state(Generator& generator) {
  return {uniform(generator, -0.5, 4.5), uniform(generator, -0.5, 3.5),
          uniform(generator, -4.0, 4.0), uniform(generator, -3.0, 1.0)};
}

/// The smallest clearance of points of the body, each by itself, with the speed far from its limit.
double searched(const Eigen::Vector4d& state, const Body& body) {
  const UnsafeSet point(room({}));
  double least = kInfinity;
  constexpr int kAngles = 720;
  for (const Disc& disc : body.discs) {
    const Eigen::Vector2d centre =
        state.head<2>() +
        Eigen::Vector2d(
            std::cos(state[2]) * disc.offset.x() - std::sin(state[2]) * disc.offset.y(),
            std::sin(state[2]) * disc.offset.x() + std::cos(state[2]) * disc.offset.y());
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kAngles;
      Eigen::Vector4d at = state;
      at.head<2>() = centre + disc.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      least = std::min(least, clearance(at, point));
    }
  }
  return least;
}

TEST(Body, clearance_is_that_of_its_nearest_point) {
  Generator generator(5);
  const UnsafeSet unsafe(room(car()));
  int safe = 0;
  for (int n = 0; n < 300; ++n) {
    Eigen::Vector4d state = random_state(generator);
    state[3] = -10.0;
    const double expected = searched(state, car());
    const double found = clearance(state, unsafe);
    // Both agree on safety; the depth is defined by discs, not by points.
    EXPECT_EQ(found > 0.0, expected > 0.0) << state.transpose();
    if (expected <= 0.0) continue;
    ++safe;
    EXPECT_NEAR(found, expected, 1e-4) << state.transpose();
  }
  EXPECT_GT(safe, 100);
}

TEST(Body, clearances_of_many_states_are_those_of_each) {
  Generator generator(6);
  const UnsafeSet unsafe(room(car()));
  Points states(4, 50);
  for (int n = 0; n < 50; ++n) states.col(n) = random_state(generator);
  states(2, 7) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd all = clearances(states, unsafe);
  for (int n = 0; n < 50; ++n) {
    const double one = clearance(states.col(n), unsafe);
    if (n == 7) {
      EXPECT_EQ(all[n], -kInfinity);
      EXPECT_EQ(one, -kInfinity);
    } else {
      EXPECT_NEAR(all[n], one, 1e-14);
    }
  }
}

// The state error needed to become unsafe is at least the clearance divided by this constant.
TEST(Body, no_disc_moves_farther_than_the_lipschitz_constant_says) {
  Generator generator(7);
  const UnsafeSet unsafe(room(car()));
  double largest = 0.0;
  for (const DiscView& disc : unsafe.discs()) {
    for (int n = 0; n < 2000; ++n) {
      const Eigen::Vector4d state = random_state(generator);
      const Eigen::Vector4d error = 1e-4 * random_matrix(generator, 4, 1);
      const double moved =
          (disc.placement.of(state + error) - disc.placement.of(state)).norm() / error.norm();
      EXPECT_LE(moved, disc.placement.lipschitz() + 1e-9);
      largest = std::max(largest, moved);
    }
  }
  EXPECT_GT(largest, 0.97 * unsafe.lipschitz());
}

TEST(Body, placements_pull_derivatives_back) {
  Generator generator(8);
  constexpr double kStep = 1e-6;
  for (const Disc& disc : car().discs) {
    const DiscPlacement placement(car(), disc);
    const Points states = random_matrix(generator, 4, 9, 2.0);
    const Points by_moved = random_matrix(generator, 4, 5);
    const ParticleRange range{.begin = 3, .end = 8};
    Points adjoint = Points::Constant(4, 9, 0.5);
    placement.pull_back(states, range, by_moved, adjoint);
    EXPECT_TRUE((adjoint.leftCols(3).array() == 0.5).all());
    EXPECT_TRUE((adjoint.rightCols(1).array() == 0.5).all());
    const Points direction = random_matrix(generator, 4, 9);
    Points high;
    Points low;
    placement.of(states + kStep * direction, range, high);
    placement.of(states - kStep * direction, range, low);
    EXPECT_NEAR((adjoint.array() - 0.5).matrix().cwiseProduct(direction).sum(),
                by_moved.cwiseProduct(high - low).sum() / (2.0 * kStep), 1e-8);
  }
}

TEST(Body, what_restricts_no_position_counts_once) {
  const UnsafeSet unsafe(room(car()));
  const Gaussian law{.mean = Eigen::Vector4d(0.5, 0.5, 0.3, 1.9),
                     .covariance = 1e-4 * Eigen::Matrix4d::Identity()};
  const double of_body = soft_unsafe_probability(law.mean, law.covariance, unsafe, 0.2);
  const double of_point = soft_unsafe_probability(law.mean, law.covariance, room({}), 0.2);
  EXPECT_NEAR(of_body, of_point, 1e-9);
  EXPECT_GT(of_point, 0.1);
}

TEST(Body, has_no_room_where_it_is_wider_than_the_bounds) {
  Body wide = car();
  wide.discs = {{.radius = 4.0}};
  const UnsafeSet unsafe(room(wide));
  Generator generator(9);
  for (int n = 0; n < 50; ++n) {
    const Eigen::Vector4d state = random_state(generator);
    EXPECT_LT(clearance(state, unsafe), 0.0);
    EXPECT_EQ(soft_unsafe_probability(state, 0.01 * Eigen::Matrix4d::Identity(), unsafe, 0.1), 1.0);
  }
}

TEST(Body, refuses_what_states_cannot_place) {
  const auto with = [](const Disc& disc, int x, int y, int heading) {
    return room({.discs = {disc}, .x = x, .y = y, .heading = heading});
  };
  EXPECT_NO_THROW(UnsafeSet(with({.radius = 0.1}, 0, -1, -1)));
  EXPECT_THROW(UnsafeSet(with({.radius = 0.1}, -1, -1, -1)), std::invalid_argument);
  EXPECT_THROW(UnsafeSet(with({.radius = 0.1}, 7, 9, -1)), std::invalid_argument);
  EXPECT_THROW(UnsafeSet(with({.radius = 0.1, .offset = {0.1, 0.0}}, 0, 1, -1)),
               std::invalid_argument);
  EXPECT_THROW(UnsafeSet(with({.radius = -0.1}, 0, 1, 2)), std::invalid_argument);
  EXPECT_THROW(UnsafeSet(with({.radius = kInfinity}, 0, 1, 2)), std::invalid_argument);
}

}  // namespace body_test
}  // namespace qsmpc::controller
