// A small world, and helpers for checks of pictures.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "render/colour.hpp"
#include "render/frame.hpp"
#include "render/hud/canvas.hpp"
#include "render/renderer.hpp"

namespace qsmpc::render {

inline const std::string kRedBox =
    std::string(QSMPC_SOURCE_DIR) + "/tests/data/red_box_vehicle.xml";

inline World small_world() {
  World world;
  world.bounds = {-3.0, 3.0, -3.0, 3.0};
  world.target = {2.4, 2.4};
  world.target_radius = 0.3;
  return world;
}

inline RenderOptions small_picture(const std::string& camera) {
  return {.width = 640, .height = 360, .camera = camera, .chase_distance = 0.0, .region = {}};
}

/// A single particle with the whole weight: the largest disc that is drawn.
inline Frame frame_with_particle(const PlanarPoint& particle) {
  Frame frame;
  frame.particles.push_back({.points = {particle}, .weights = {1.0}});
  return frame;
}

struct Pixel {
  int red = 0;
  int green = 0;
  int blue = 0;
};

/// The pixel at `place`; fails the test if it is outside the picture.
inline Pixel pixel_at(const Image& image, const PixelPoint& place) {
  const int x = static_cast<int>(std::floor(place.x));
  const int y = static_cast<int>(std::floor(place.y));
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) {
    ADD_FAILURE() << "(" << x << ", " << y << ") is not in the picture";
    return {};
  }
  const std::size_t index = 3 * (static_cast<std::size_t>(y) * image.width + x);
  return {image.rgb[index], image.rgb[index + 1], image.rgb[index + 2]};
}

/// Largest difference of a channel, out of 255.
inline int colour_difference(const Pixel& pixel, const Colour& colour) {
  const auto difference = [](int value, float wanted) {
    return std::abs(value - static_cast<int>(std::lround(255.0F * wanted)));
  };
  return std::max({difference(pixel.red, colour.red), difference(pixel.green, colour.green),
                   difference(pixel.blue, colour.blue)});
}

/// An empty folder for the running test.
inline std::filesystem::path fresh_folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  for (char& character : name) {
    character = character == '/' ? '_' : character;
  }
  const auto folder = std::filesystem::temp_directory_path() / "qsmpc_tests" / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace qsmpc::render
