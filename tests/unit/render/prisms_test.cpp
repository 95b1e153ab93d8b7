// Obstacles of any outline in the picture.
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "render/palette.hpp"
#include "render/scene/outlines.hpp"
#include "render/scene/scene_painter.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace prisms_test {

constexpr double kObstacleTop = 0.4;  // m
constexpr int kSameColour = 60;
constexpr int kOtherColour = 70;

/// A 2 m square about the origin, shifted by (0.5, 0.5), without its upper right quarter.
const PlanarOutline kCorner = {{-0.5, -0.5}, {1.5, -0.5}, {1.5, 0.5},
                               {0.5, 0.5},   {0.5, 1.5},  {-0.5, 1.5}};

Prism corner_prism() {
  return {.outline = kCorner,
          .pieces = {{{-0.5, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {-0.5, 0.5}},
                     {{-0.5, 0.5}, {0.5, 0.5}, {0.5, 1.5}, {-0.5, 1.5}}}};
}

Prism convex(const PlanarOutline& outline) { return {.outline = outline, .pieces = {outline}}; }

double area_of(const PlanarOutline& outline) {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const PlanarPoint& next = outline[(i + 1) % outline.size()];
    twice += outline[i].x * next.y - next.x * outline[i].y;
  }
  return 0.5 * twice;
}

/// The picture of `world` with the vehicle out of the way.
struct Picture {
  Renderer renderer;
  Frame frame;
  Image image;

  Picture(const World& world, const std::string& camera)
      : renderer(small_picture(camera), world, kRedBox) {
    frame.qpos = {-2.5, 2.5, 0.1, 1.0, 0.0, 0.0, 0.0};
    renderer.draw(frame, image);
  }
  [[nodiscard]] Pixel at(double x, double y, double z) {
    return pixel_at(image, *renderer.locate(frame, {x, y}, z));
  }
};

TEST(prisms, stripes_fill_an_outline_that_is_not_convex) {
  constexpr double kSpacing = 0.01;
  std::vector<SpacePoint> ends;
  append_stripes(kCorner, 0.3, kSpacing, ends);
  ASSERT_EQ(ends.size() % 2, 0U);
  double length = 0.0;
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    length += std::hypot(ends[i + 1][0] - ends[i][0], ends[i + 1][1] - ends[i][1]);
    const double x = 0.5 * (ends[i][0] + ends[i + 1][0]);
    const double y = 0.5 * (ends[i][1] + ends[i + 1][1]);
    EXPECT_FALSE(x > 0.5 && y > 0.5) << x << ", " << y;
    EXPECT_EQ(ends[i][2], 0.3);
  }
  // Stripes are kSpacing/√2 apart.
  EXPECT_NEAR(length * kSpacing / std::numbers::sqrt2, area_of(kCorner), 0.02);
}

TEST(prisms, are_cut_to_a_rectangle_with_their_pieces) {
  const Prism part = clipped_to(corner_prism(), PlanarRectangle{0.0, 1.0, 0.0, 1.0});
  EXPECT_NEAR(area_of(part.outline), 0.75, 1e-12);
  ASSERT_EQ(part.pieces.size(), 2U);
  EXPECT_NEAR(area_of(part.pieces[0]) + area_of(part.pieces[1]), 0.75, 1e-12);
  const Prism none = clipped_to(corner_prism(), PlanarRectangle{0.6, 1.0, 0.6, 1.0});
  EXPECT_TRUE(none.outline.empty());
  EXPECT_TRUE(none.pieces.empty());
}

TEST(prisms, look_like_a_box_of_the_same_outline) {
  World boxed = small_world();
  boxed.obstacles = {{0.4, 1.6, -0.5, 0.9}};
  World other = small_world();
  other.prisms = {convex({{0.4, -0.5}, {1.6, -0.5}, {1.6, 0.9}, {0.4, 0.9}})};
  for (const char* camera : {"chase", "top", "fixed"}) {
    const Picture box(boxed, camera);
    const Picture prism(other, camera);
    std::size_t different = 0;
    for (std::size_t i = 0; i < box.image.rgb.size(); ++i) {
      different += std::abs(box.image.rgb[i] - prism.image.rgb[i]) > 8 ? 1 : 0;
    }
    // A prism is slightly behind, so its foot differs by a pixel, and its lines are smoothed
    // differently where their ends meet: 0.2 %.
    EXPECT_LT(different, box.image.rgb.size() / 300) << camera;
  }
}

TEST(prisms, of_a_corner_leave_the_ground_in_it_free) {
  World world = small_world();
  world.prisms = {corner_prism()};
  Picture picture(world, "top");
  Picture empty(small_world(), "top");
  // Neither point is in the shadow: one is inside the corner, the other outside the shape.
  for (const PlanarPoint& free : {PlanarPoint{1.3, 1.3}, PlanarPoint{-0.9, 1.3}}) {
    const Pixel pixel = picture.at(free.x, free.y, 0.0);
    const Pixel ground = empty.at(free.x, free.y, 0.0);
    EXPECT_LT(std::abs(pixel.red - ground.red), 12);
    EXPECT_LT(std::abs(pixel.blue - ground.blue), 12);
  }
  int differing = 0;
  for (const PlanarPoint& top : {PlanarPoint{1.1, 0.05}, PlanarPoint{0.05, 1.1},
                                 PlanarPoint{0.05, 0.05}, PlanarPoint{-0.3, -0.3}}) {
    const Pixel pixel = picture.at(top.x, top.y, kObstacleTop);
    differing += colour_difference(pixel, palette::kObstacle) > kSameColour ? 1 : 0;
  }
  EXPECT_LE(differing, 1);  // a stripe may cross one of them
}

TEST(prisms, in_front_hide_a_particle) {
  const PlanarPoint particle{1.1, 0.0};
  const Frame frame = frame_with_particle(particle);
  World world = small_world();
  // A square standing on its corner, between the chase camera and the point.
  world.prisms = {convex({{0.4, 0.0}, {0.8, -0.4}, {1.0, 0.0}, {0.8, 0.4}})};
  Renderer renderer(small_picture("chase"), world, kRedBox);
  Image image;
  renderer.draw(frame, image);
  EXPECT_GT(
      colour_difference(pixel_at(image, *renderer.locate(frame, particle)), stage_colour(0, 1)),
      kOtherColour);
}

TEST(prisms, that_move_stand_where_the_frame_has_them_in_a_colour_of_their_own) {
  Renderer renderer(small_picture("top"), small_world(), kRedBox);
  Frame frame;
  frame.qpos = {-2.5, 2.5, 0.1, 1.0, 0.0, 0.0, 0.0};
  Image image;
  const auto differing = [&](double x) {
    renderer.draw(frame, image);
    int count = 0;
    for (const PlanarPoint& top : {PlanarPoint{x - 0.3, 0.1}, PlanarPoint{x, -0.2},
                                   PlanarPoint{x + 0.2, 0.15}, PlanarPoint{x, 0.3}}) {
      const Pixel pixel = pixel_at(image, *renderer.locate(frame, top, kObstacleTop));
      count += colour_difference(pixel, palette::kMovingObstacle) > kSameColour ? 1 : 0;
    }
    return count;
  };
  frame.moving = {convex({{-1.5, -0.5}, {-0.5, -0.5}, {-0.5, 0.5}, {-1.5, 0.5}})};
  EXPECT_LE(differing(-1.0), 2);  // stripes may cross some of them
  frame.moving = {convex({{0.5, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {0.5, 0.5}})};
  EXPECT_LE(differing(1.0), 2);
  EXPECT_EQ(differing(-1.0), 4);
}

TEST(prisms, half_planes_reach_to_the_end_of_the_ground_and_leave_the_region_as_it_is) {
  World world = small_world();
  world.half_planes = {{{1.0, 1.0}, 2.0}};
  const PlanarRectangle region = world_region(world);
  EXPECT_EQ(region.x_upper, 3.0);
  EXPECT_EQ(region.y_lower, -3.0);
  Picture picture(world, "top");
  Picture empty(small_world(), "top");
  for (const PlanarPoint& inside : {PlanarPoint{2.9, 2.7}, PlanarPoint{1.3, 1.25}}) {
    const Pixel with = picture.at(inside.x, inside.y, kObstacleTop);
    const Pixel without = empty.at(inside.x, inside.y, kObstacleTop);
    EXPECT_GT(std::abs(with.red - without.red) + std::abs(with.green - without.green) +
                  std::abs(with.blue - without.blue),
              40);
  }
  const Pixel before = picture.at(-1.3, -1.3, 0.0);
  const Pixel ground = empty.at(-1.3, -1.3, 0.0);
  EXPECT_LT(std::abs(before.red - ground.red), 12);
}

TEST(prisms, and_edges_of_half_planes_that_are_near_are_in_the_region) {
  World world;
  world.bounds = {-kInfinity, kInfinity, -kInfinity, kInfinity};
  world.target = {2.0, 2.0};
  world.prisms = {convex({{0.0, 0.0}, {4.0, 0.0}, {0.0, 5.0}})};
  world.half_planes = {{{0.0, -2.0}, 6.0}};  // y ≤ −3
  PlanarRectangle region = world_region(world);
  EXPECT_EQ(region.x_upper, 4.0);
  EXPECT_EQ(region.y_upper, 5.0);
  EXPECT_NEAR(region.y_lower, -3.0, 1e-12);
  world.half_planes = {{{0.0, -2.0}, 600.0}};  // far away
  region = world_region(world);
  EXPECT_EQ(region.y_lower, 0.0);
}

}  // namespace prisms_test
}  // namespace qsmpc::render
