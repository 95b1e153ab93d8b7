// The distance by which a law may be moved before a region has a tail, which lets the model of a
// plan's risk pass over regions.
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "controller/regions/planar/moving_shape.hpp"
#include "controller/regions/planar/shape_region.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace distance_without_tail_test {

using namespace testing;

constexpr Growth kGrowth{.radius = 0.1, .x = 0, .y = 1};

RegionPointer moving_disc() {
  auto forecast = std::make_shared<ObstacleForecast>(1);
  const Eigen::Matrix2d spread = 0.04 * Eigen::Matrix2d::Identity();
  forecast->set(0, {{{.weight = 0.3, .offset = {1.0, 0.0}, .covariance = spread},
                     {.weight = 0.7, .offset = {-2.0, 1.0}, .turn = 0.5, .covariance = spread}}});
  return make_moving_shape(DiscShape{.centre = {0.2, -0.1}, .radius = 0.3}, kGrowth, forecast, 0);
}

std::vector<std::pair<std::string, RegionPointer>> regions() {
  const Box everything{.lower = Eigen::VectorXd::Constant(3, -kInfinity),
                       .upper = Eigen::VectorXd::Constant(3, kInfinity)};
  Box room = everything;
  room.lower.head(2).setConstant(-4.5);
  room.upper[0] = 4.5;
  Box block = everything;
  block.lower.head(2) << -0.5, -0.2;
  block.upper.head(2) << 0.6, 0.3;
  return {{"walls", make_region("walls", room, kGrowth)},
          {"box", make_region("box", block, kGrowth)},
          {"disc", make_shape(DiscShape{.centre = {0.2, -0.1}, .radius = 0.3}, kGrowth)},
          {"turned box", make_shape(TurnedBoxShape{.size = {1.0, 0.3}, .angle = 0.7}, kGrowth)},
          {"half-plane", make_shape(HalfPlaneShape{.normal = {0.6, 0.8}, .offset = 2.0}, kGrowth)},
          {"moving disc", moving_disc()}};
}

double tail_of(const UnsafeRegion& region, const Gaussian& law) {
  TailSum sum;
  sum.clear(3);
  region.add_tail(0, law, sum);
  return sum.value();
}

TEST(DistanceWithoutTail, is_one_within_which_there_is_none) {
  // Moving shapes leave out tails of more than ten deviations.
  constexpr double kNothing = 1e-22;
  Generator generator(71);
  for (const auto& [name, region] : regions()) {
    SCOPED_TRACE(name);
    int silent = 0;
    int near = 0;
    for (int repetition = 0; repetition < 400; ++repetition) {
      const Eigen::MatrixXd root = random_matrix(generator, 3, 3, 0.02);
      Gaussian law{.mean = random_matrix(generator, 3, 1, 4.0),
                   .covariance = root * root.transpose()};
      const double distance = region->distance_without_tail(0, law);
      if (distance == 0.0) {
        ++near;
        continue;
      }
      ++silent;
      EXPECT_LE(tail_of(*region, law), kNothing);
      law.mean += 0.999 * distance * random_matrix(generator, 3, 1).normalized();
      EXPECT_LE(tail_of(*region, law), kNothing);
    }
    EXPECT_GT(silent, 20);
    EXPECT_GT(near, 5);
  }
}

TEST(DistanceWithoutTail, is_none_where_there_is_a_tail) {
  Generator generator(72);
  for (const auto& [name, region] : regions()) {
    SCOPED_TRACE(name);
    int tails = 0;
    for (int repetition = 0; repetition < 400; ++repetition) {
      const Eigen::MatrixXd root = random_matrix(generator, 3, 3, 0.4);
      const Gaussian law{.mean = random_matrix(generator, 3, 1, 4.0),
                         .covariance = root * root.transpose()};
      if (tail_of(*region, law) < 1e-20) continue;
      ++tails;
      EXPECT_EQ(region->distance_without_tail(0, law), 0.0);
    }
    EXPECT_GT(tails, 20);
  }
}

}  // namespace distance_without_tail_test
}  // namespace qsmpc::controller
