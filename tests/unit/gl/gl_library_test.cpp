// One OpenGL library per process: each drawing happens in a child process that runs this program.
#include "render/gl/gl_library.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/media/png_image.hpp"
#include "tests/unit/render/decoded_video.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace gl_library_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Frame example_frame() {
  Frame frame = frame_with_particle({1.2, 0.4});
  frame.pose = {-0.5, 0.3, 0.6};
  frame.planned_path = {{-0.5, 0.3}, {0.2, 0.5}, {1.2, 0.4}};
  frame.driven_path = {{-1.5, -0.6}, {-0.5, 0.3}};
  frame.title = "one picture, two libraries";
  return frame;
}

// Draws a picture with the library into a file; prints the vehicle's expected place and the
// renderer.
void draw(const std::string& library, const std::string& path) {
  use_gl(library);
  World world = small_world();
  world.obstacles.push_back({0.5, 1.5, -1.5, -0.7});
  Renderer renderer(small_picture("fixed"), world, kRedBox);
  const Frame frame = example_frame();
  Image image;
  renderer.draw(frame, image);
  std::ofstream(path, std::ios::binary) << encode_png(image);
  const PixelPoint vehicle = renderer.locate(frame, {frame.pose.x, frame.pose.y}, 0.2).value();
  std::cout << vehicle.x << ' ' << vehicle.y << ' ' << gl_description() << '\n';
}

// Whether an OpenGL library is loaded in this process.
bool is_mapped() {
  std::ifstream maps("/proc/self/maps");
  const std::string text{std::istreambuf_iterator<char>(maps), {}};
  return text.find("libOSMesa") != std::string::npos || text.find("libEGL") != std::string::npos ||
         text.find("libGL.so") != std::string::npos || text.find("libOpenGL") != std::string::npos;
}

struct Child {
  std::string output;
  int status = -1;
};

Child run_child(const std::string& arguments) {
  const std::string command =
      "'" + std::filesystem::read_symlink("/proc/self/exe").string() + "' " + arguments + " 2>&1";
  Child child;
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    return child;
  }
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) {
    child.output += buffer.data();
  }
  child.status = pclose(pipe);
  return child;
}

struct Drawn {
  Image image;
  PixelPoint vehicle;
  std::string description;
};

Drawn drawn_with(const std::string& library) {
  const std::string path = fresh_folder() / (library + ".png");
  const Child child = run_child("--draw " + library + " '" + path + "'");
  EXPECT_EQ(child.status, 0) << child.output;
  Drawn drawn;
  if (child.status != 0) {
    return drawn;
  }
  std::istringstream words(child.output);
  words >> drawn.vehicle.x >> drawn.vehicle.y >> std::ws;
  std::getline(words, drawn.description);
  drawn.image = decode_video(path).first;
  return drawn;
}

TEST(gl_library, egl_draws_what_osmesa_draws) {
  const Drawn osmesa = drawn_with("osmesa");
  const Drawn egl = drawn_with("egl");
  EXPECT_THAT(osmesa.description, StartsWith("osmesa: "));
  EXPECT_THAT(egl.description, StartsWith("egl: "));
  ASSERT_EQ(osmesa.image.rgb.size(), egl.image.rgb.size());
  ASSERT_FALSE(egl.image.rgb.empty());
  // Another driver may rasterise edges differently: one pixel in a thousand.
  std::size_t different = 0;
  for (std::size_t i = 0; i < egl.image.rgb.size(); ++i) {
    different += std::abs(egl.image.rgb[i] - osmesa.image.rgb[i]) > 8 ? 1 : 0;
  }
  EXPECT_LT(different, egl.image.rgb.size() / 1000);
}

TEST(gl_library, egl_draws_the_vehicle_where_it_projects) {
  const Drawn egl = drawn_with("egl");
  ASSERT_FALSE(egl.image.rgb.empty());
  const Pixel pixel = pixel_at(egl.image, egl.vehicle);
  EXPECT_GT(pixel.red, 2 * pixel.green);
  EXPECT_GT(pixel.red, 2 * pixel.blue);
}

TEST(gl_library, auto_is_osmesa_where_it_is_installed) {
  EXPECT_THAT(drawn_with("auto").description, StartsWith("osmesa: "));
}

TEST(gl_library, a_second_library_in_a_process_is_refused) {
  const Child child = run_child("--use osmesa egl");
  EXPECT_NE(child.status, 0);
  EXPECT_THAT(child.output, HasSubstr("egl was asked for"));
  EXPECT_THAT(child.output, HasSubstr("osmesa is already loaded"));
  EXPECT_EQ(run_child("--use egl egl").status, 0);
  EXPECT_EQ(run_child("--use egl auto").status, 0);
}

TEST(gl_library, nothing_is_loaded_before_something_is_drawn) {
  const Child child = run_child("--mapped");
  EXPECT_EQ(child.output, "no\n");
}

TEST(gl_library, without_any_library_the_error_names_those_tried_and_what_to_install) {
  try {
    (void)open_gl("auto", {.osmesa = {"libNoMesa.so.8", "libNoMesa.so"}, .egl = {"libNoEGL.so"}});
    FAIL() << "a library that does not exist was opened";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("libNoMesa.so.8, libNoMesa.so, libNoEGL.so"));
    EXPECT_THAT(error.what(), HasSubstr("install OSMesa (Debian: libosmesa6)"));
  }
}

TEST(gl_library, auto_takes_egl_where_osmesa_is_missing_and_a_wish_takes_nothing_else) {
  const GlCandidates only_egl{.osmesa = {"libNoMesa.so"}, .egl = {"libNoEGL.so", "libEGL.so.1"}};
  EXPECT_EQ(open_gl("auto", only_egl).backend, GlBackend::kEgl);
  EXPECT_THROW((void)open_gl("osmesa", only_egl), std::runtime_error);
}

TEST(gl_library, unknown_names_are_refused_with_the_known_ones) {
  try {
    use_gl("vulkan");
    FAIL() << "it was loaded";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"vulkan\" is not one of auto, osmesa, egl"));
  }
}

int child_main(const std::string& what, const std::string& first, const std::string& second) {
  try {
    if (what == "--draw") {
      draw(first, second);
    } else if (what == "--use") {
      use_gl(first);
      use_gl(second);
    } else {
      std::cout << (is_mapped() ? "yes\n" : "no\n");
    }
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
}

}  // namespace gl_library_test
}  // namespace qsmpc::render

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc > 1) {
    const auto argument = [&](int i) -> std::string { return i < argc ? argv[i] : ""; };
    return qsmpc::render::gl_library_test::child_main(argument(1), argument(2), argument(3));
  }
  return RUN_ALL_TESTS();
}
