#include "render/renderer.hpp"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace renderer_test {

// Smoothing and the particles' opacity mix some of the surroundings into a colour; a different
// colour is as far from it as two stages' colours are from each other.
constexpr int kSameColour = 60;
constexpr int kOtherColour = 150;

bool is_red(const Pixel& pixel) { return pixel.red > 180 && pixel.green < 70 && pixel.blue < 70; }

class EveryCamera : public ::testing::TestWithParam<const char*> {
 protected:
  Renderer renderer_{small_picture(GetParam()), small_world(), kRedBox};
  Image image_;
};

INSTANTIATE_TEST_SUITE_P(Cameras, EveryCamera, ::testing::Values("chase", "top", "fixed"));

TEST_P(EveryCamera, vehicle_is_drawn_where_its_pose_projects) {
  Frame frame;
  frame.pose = {0.8, -0.5, 0.7};
  renderer_.draw(frame, image_);
  EXPECT_EQ(image_.width, 640);
  EXPECT_EQ(image_.height, 360);
  const auto place = renderer_.locate(frame, {0.8, -0.5}, 0.2);
  ASSERT_TRUE(place);
  EXPECT_TRUE(is_red(pixel_at(image_, *place)));
  const auto elsewhere = renderer_.locate(frame, {0.8 + 0.5, -0.5}, 0.0);
  ASSERT_TRUE(elsewhere);
  EXPECT_FALSE(is_red(pixel_at(image_, *elsewhere)));
}

TEST_P(EveryCamera, qpos_places_the_vehicle_and_pose_does_not) {
  Frame frame;
  frame.pose = {0.2, 0.0, 0.0};
  frame.qpos = {-0.4, 0.6, 0.1, 1.0, 0.0, 0.0, 0.0};
  renderer_.draw(frame, image_);
  EXPECT_TRUE(is_red(pixel_at(image_, *renderer_.locate(frame, {-0.4, 0.6}, 0.2))));
  EXPECT_FALSE(is_red(pixel_at(image_, *renderer_.locate(frame, {0.2, 0.0}, 0.0))));
}

TEST_P(EveryCamera, particle_is_drawn_where_its_coordinates_project) {
  const PlanarPoint particle{1.0, 0.3};
  const Frame frame = frame_with_particle(particle);
  renderer_.draw(frame, image_);
  const auto place = renderer_.locate(frame, particle);
  ASSERT_TRUE(place);
  EXPECT_LT(colour_difference(pixel_at(image_, *place), stage_colour(0, 1)), kSameColour);

  renderer_.draw(Frame{}, image_);
  EXPECT_GT(colour_difference(pixel_at(image_, *place), stage_colour(0, 1)), kOtherColour);
}

TEST_P(EveryCamera, the_same_frame_gives_the_same_picture_whatever_came_between) {
  Frame frame = frame_with_particle({1.0, 0.3});
  frame.hud = {{"time", "1.0 s"}};
  renderer_.draw(frame, image_);
  Image other;
  Frame between;
  between.pose = {1.0, 1.0, 2.0};
  renderer_.draw(between, other);
  EXPECT_NE(image_.rgb, other.rgb);
  renderer_.draw(frame, other);
  EXPECT_EQ(image_.rgb, other.rgb);
}

TEST(renderer, two_threads_draw_the_same_picture) {
  const Frame frame = frame_with_particle({1.0, 0.3});
  Image images[2];
  const auto draw = [&frame](Image& image) {
    Renderer renderer(small_picture("chase"), small_world(), kRedBox);
    renderer.draw(frame, image);
  };
  std::thread first(draw, std::ref(images[0]));
  std::thread second(draw, std::ref(images[1]));
  first.join();
  second.join();
  ASSERT_FALSE(images[0].rgb.empty());
  EXPECT_EQ(images[0].rgb, images[1].rgb);
}

TEST(renderer, obstacle_in_front_hides_a_particle) {
  // The chase camera looks along x from behind the origin; the box stands between it and the point.
  const PlanarPoint particle{1.1, 0.0};
  Frame frame = frame_with_particle(particle);
  World world = small_world();
  Image image;
  {
    Renderer renderer(small_picture("chase"), world, kRedBox);
    renderer.draw(frame, image);
    EXPECT_LT(
        colour_difference(pixel_at(image, *renderer.locate(frame, particle)), stage_colour(0, 1)),
        kSameColour);
  }
  world.obstacles = {{0.6, 1.0, -0.5, 0.5}};
  Renderer renderer(small_picture("chase"), world, kRedBox);
  renderer.draw(frame, image);
  const PixelPoint place = *renderer.locate(frame, particle);
  const Pixel hidden = pixel_at(image, place);
  renderer.draw(Frame{}, image);
  const Pixel without = pixel_at(image, place);
  EXPECT_EQ(hidden.red, without.red);
  EXPECT_EQ(hidden.green, without.green);
  EXPECT_EQ(hidden.blue, without.blue);
}

TEST(renderer, obstacle_in_front_does_not_hide_the_vehicle) {
  World world = small_world();
  world.obstacles = {{-0.6, -0.35, -0.5, 0.5}};  // between the chase camera and the vehicle
  Renderer renderer(small_picture("chase"), world, kRedBox);
  const Frame frame;
  Image image;
  renderer.draw(frame, image);
  const PixelPoint middle = *renderer.locate(frame, {0.0, 0.0}, 0.05);
  // Averaged over several places: the obstacle's top has red stripes.
  const auto redness = [&image, &middle] {
    int surplus = 0;
    for (double dx = -20.0; dx <= 20.0; ++dx) {
      const Pixel pixel = pixel_at(image, {middle.x + dx, middle.y});
      surplus += pixel.red - pixel.blue;
    }
    return surplus / 41;
  };
  const int shining_through = redness();
  Frame away = frame;
  away.qpos = {2.0, 2.0, 0.1, 1.0, 0.0, 0.0, 0.0};
  renderer.draw(away, image);
  EXPECT_GT(shining_through, redness() + 60);
}

// The file's lamps would make everything white, and its terrain is 40 m long and rises above the
// ground.
const std::string kBlueBoxOnTerrain =
    std::string(QSMPC_SOURCE_DIR) + "/tests/data/blue_box_on_terrain.xml";

TEST(renderer, colours_are_those_of_the_file_whatever_its_lamps) {
  Renderer renderer(small_picture("top"), small_world(), kBlueBoxOnTerrain);
  const Frame frame;
  Image image;
  renderer.draw(frame, image);
  const Pixel roof = pixel_at(image, *renderer.locate(frame, {0.0, 0.0}, 0.2));
  EXPECT_LT(colour_difference(roof, {0.2F, 0.4F, 0.8F}), 20);
}

TEST(renderer, terrain_makes_the_vehicle_neither_smaller_nor_hidden) {
  const auto width_of = [](const std::string& mjcf) {
    const Renderer renderer(small_picture("chase"), small_world(), mjcf);
    return renderer.locate({}, {0.0, -0.15})->x - renderer.locate({}, {0.0, 0.15})->x;
  };
  EXPECT_NEAR(width_of(kBlueBoxOnTerrain), width_of(kRedBox), 1e-9);
  Renderer renderer(small_picture("chase"), small_world(), kBlueBoxOnTerrain);
  Frame frame;
  frame.qpos = {-1.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0};  // behind the mound at x = -1.6
  frame.pose = {-1.0, 0.0, 0.0};
  Image image;
  renderer.draw(frame, image);
  const Pixel vehicle = pixel_at(image, *renderer.locate(frame, {-1.0, 0.0}, 0.1));
  EXPECT_GT(vehicle.blue, vehicle.red + 40);
}

TEST(renderer, particles_are_fainter_on_the_vehicle) {
  Renderer renderer(small_picture("top"), small_world(), kRedBox);
  const auto strength = [&renderer](const PlanarPoint& vehicle) {
    Frame frame = frame_with_particle({0.0, 0.35});
    frame.pose = {vehicle.x, vehicle.y, 0.0};
    Image image;
    renderer.draw(frame, image);
    return colour_difference(pixel_at(image, *renderer.locate(frame, {0.0, 0.35})),
                             stage_colour(0, 1));
  };
  EXPECT_GT(strength({0.0, 0.0}), strength({-2.0, -2.0}) + 50);
}

TEST(renderer, area_of_a_particle_grows_with_its_weight) {
  Renderer renderer(
      {.width = 1920, .height = 1080, .camera = "chase", .chase_distance = 0.0, .region = {}},
      small_world(),
      kRedBox);  // large discs: small errors
  const auto coloured_pixels = [&renderer](double weight) {
    Frame frame;
    frame.particles.push_back({.points = {{1.0, 0.0}}, .weights = {weight}});
    Image image;
    renderer.draw(frame, image);
    const PixelPoint centre = *renderer.locate(frame, {1.0, 0.0});
    int count = 0;
    for (double dy = -15.0; dy <= 15.0; ++dy) {
      for (double dx = -15.0; dx <= 15.0; ++dx) {
        const Pixel pixel = pixel_at(image, {centre.x + dx, centre.y + dy});
        count += colour_difference(pixel, stage_colour(0, 1)) < kSameColour ? 1 : 0;
      }
    }
    return count;
  };
  // Four times the weight gives four times the area; discs of 12 and 24 pixels leave an uncertainty
  // of a quarter.
  const int light = coloured_pixels(0.015);
  const int heavy = coloured_pixels(0.06);
  EXPECT_GT(light, 0);
  EXPECT_GT(heavy, 3.0 * light);
  EXPECT_LT(heavy, 5.0 * light);
}

TEST(renderer, top_and_fixed_cameras_show_all_of_the_bounds) {
  for (const char* camera : {"top", "fixed"}) {
    const Renderer renderer(small_picture(camera), small_world(), kRedBox);
    Frame frame;
    for (const PlanarPoint& corner : {PlanarPoint{-3.0, -3.0}, PlanarPoint{3.0, -3.0},
                                      PlanarPoint{3.0, 3.0}, PlanarPoint{-3.0, 3.0}}) {
      const auto place = renderer.locate(frame, corner);
      ASSERT_TRUE(place);
      EXPECT_GT(place->x, 0.22 * 640) << camera;  // the display takes up some of it
      EXPECT_LT(place->x, 640) << camera;
      EXPECT_GT(place->y, 0) << camera;
      EXPECT_LT(place->y, 360) << camera;
    }
  }
}

TEST(renderer, draws_without_bounds) {
  World world;
  world.bounds = {-kInfinity, kInfinity, -kInfinity, kInfinity};
  world.obstacles = {{1.0, 2.0, -kInfinity, kInfinity}};
  Renderer renderer(small_picture("fixed"), world, kRedBox);
  Image image;
  renderer.draw(Frame{}, image);
  EXPECT_EQ(image.rgb.size(), 3U * 640U * 360U);
}

TEST(renderer, refuses_frames_that_do_not_fit_the_vehicle) {
  Renderer renderer(small_picture("top"), small_world(), kRedBox);
  Image image;
  Frame frame;
  frame.qpos = {1.0, 2.0};
  EXPECT_THROW(renderer.draw(frame, image), std::invalid_argument);
  frame.qpos.clear();
  frame.pose.x = std::nan("");
  EXPECT_THROW(renderer.draw(frame, image), std::invalid_argument);
  frame.pose.x = 0.0;
  renderer.draw(frame, image);  // and works after both
  EXPECT_FALSE(image.rgb.empty());
}

TEST(renderer, refuses_unknown_cameras_and_invalid_sizes) {
  EXPECT_THROW(Renderer(small_picture("front"), small_world(), kRedBox), std::invalid_argument);
  RenderOptions options;
  options.width = 0;
  EXPECT_THROW(Renderer(options, small_world(), kRedBox), std::invalid_argument);
}

TEST(renderer, missing_vehicle_is_an_exception_and_leaves_no_log_file) {
  try {
    const Renderer renderer(small_picture("top"), small_world(), "/nonexistent/car.xml");
    FAIL() << "loaded a file that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/car.xml"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

}  // namespace renderer_test
}  // namespace qsmpc::render
