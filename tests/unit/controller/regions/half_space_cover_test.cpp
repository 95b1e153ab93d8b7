// The half-spaces around regions contain them and touch them.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/regions/planar/moving_shape.hpp"
#include "controller/regions/planar/shape_region.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace half_space_cover_test {

using namespace testing;

constexpr Growth kGrowth{.radius = 0.15, .x = 0, .y = 1};

Box block() {
  Box box = unbounded_safe_set(3).bounds;
  box.lower.head<2>() = Eigen::Vector2d(-0.4, -0.2);
  box.upper.head<2>() = Eigen::Vector2d(0.5, 0.6);
  return box;
}

std::shared_ptr<const ObstacleForecast> forecast(const ObstaclePlace& place) {
  auto forecast = std::make_shared<ObstacleForecast>(1);
  forecast->set(0, {{place}, {place}});
  return forecast;
}

struct Covered {
  std::string name;
  RegionPointer region;
};

std::vector<Covered> bounded_regions() {
  const PlanarShape disc = DiscShape{.centre = {0.2, -0.1}, .radius = 0.3};
  const PlanarShape ellipse =
      EllipseShape{.centre = {0.1, 0.2}, .semi_axes = {0.4, 0.2}, .angle = 0.3};
  PolygonShape corner{.corners = Eigen::Matrix2Xd(2, 6)};
  corner.corners << 0.0, 0.8, 0.8, 0.3, 0.3, 0.0,  //
      0.0, 0.0, 0.25, 0.25, 0.9, 0.9;
  return {
      {"box", make_region("box", block(), kGrowth)},
      {"disc", make_shape(disc, kGrowth)},
      {"ellipse", make_shape(ellipse, kGrowth)},
      {"corner", make_shape(corner, kGrowth)},
      {"moved corner",
       make_moving_shape(corner, kGrowth, forecast({.offset = {0.3, -0.2}, .turn = 0.8}), 0)},
  };
}

/// The smallest direction · x over many points of the region.
double least_of_region(const UnsafeRegion& region, const Eigen::VectorXd& direction,
                       Generator& generator) {
  double least = kInfinity;
  for (int i = 0; i < 40000; ++i) {
    Eigen::VectorXd point = random_matrix(generator, 3, 1);
    point.head<2>() *= 1.2;
    if (region.signed_distance(1, point) <= 0.0) least = std::min(least, direction.dot(point));
  }
  return least;
}

TEST(HalfSpaceCover, holds_a_bounded_region_and_begins_where_it_does) {
  Generator generator(311);
  for (const Covered& one : bounded_regions()) {
    for (const double angle : {0.0, 0.7, 2.5, 4.0}) {
      const Eigen::Vector3d towards(std::cos(angle), std::sin(angle), 0.0);
      const std::vector<HalfSpace> cover = one.region->half_space_cover(1, towards);
      ASSERT_EQ(cover.size(), 1U) << one.name;
      EXPECT_EQ(cover[0].normal, towards) << one.name;
      const double least = least_of_region(*one.region, towards, generator);
      EXPECT_LE(cover[0].offset, least + 1e-12) << one.name << " " << angle;
      EXPECT_GE(cover[0].offset, least - 0.08) << one.name << " " << angle;
    }
  }
}

TEST(HalfSpaceCover, of_walls_are_the_walls) {
  Generator generator(312);
  Box room = unbounded_safe_set(3).bounds;
  room.lower[0] = -0.5;
  room.upper.head<2>() = Eigen::Vector2d(0.7, 0.4);
  const RegionPointer walls = make_region("walls", room);
  const std::vector<HalfSpace> cover = walls->half_space_cover(1, Eigen::Vector3d::UnitX());
  ASSERT_EQ(cover.size(), 3U);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd point = random_matrix(generator, 3, 1);
    double deepest = -kInfinity;
    for (const HalfSpace& space : cover) {
      deepest = std::max(deepest, space.normal.dot(point) - space.offset);
    }
    EXPECT_EQ(deepest >= 0.0, walls->signed_distance(1, point) <= 0.0);
  }
}

TEST(HalfSpaceCover, is_none_where_a_direction_does_not_end_the_region) {
  const Eigen::Vector3d sideways(0.6, 0.0, 0.8);
  for (const Covered& one : bounded_regions()) {
    EXPECT_TRUE(one.region->half_space_cover(1, sideways).empty()) << one.name;
  }
  const RegionPointer half =
      make_shape(HalfPlaneShape{.normal = {0.6, 0.8}, .offset = 0.2}, kGrowth);
  EXPECT_TRUE(half->half_space_cover(1, sideways).empty());
}

TEST(HalfSpaceCover, of_a_half_plane_is_itself) {
  const PlanarShape plane = HalfPlaneShape{.normal = {1.2, 1.6}, .offset = 0.4};
  const double turn = 0.8;
  for (const RegionPointer& region :
       {make_shape(plane, kGrowth),
        make_moving_shape(plane, kGrowth, forecast({.offset = {0.3, -0.2}, .turn = turn}), 0)}) {
    const std::vector<HalfSpace> cover = region->half_space_cover(1, Eigen::Vector3d::UnitX());
    ASSERT_EQ(cover.size(), 1U);
    Generator generator(313);
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd point = random_matrix(generator, 3, 1, 2.0);
      EXPECT_NEAR(region->signed_distance(1, point), cover[0].offset - cover[0].normal.dot(point),
                  1e-12);
    }
  }
}

TEST(HalfSpaceCover, is_none_of_what_is_uncertain) {
  const PlanarShape disc = DiscShape{.centre = {0.2, -0.1}, .radius = 0.3};
  const RegionPointer region = make_moving_shape(
      disc, kGrowth, forecast({.covariance = 0.01 * Eigen::Matrix2d::Identity()}), 0);
  EXPECT_TRUE(region->half_space_cover(1, Eigen::Vector3d::UnitX()).empty());
}

}  // namespace half_space_cover_test
}  // namespace qsmpc::controller
