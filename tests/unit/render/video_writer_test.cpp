#include "render/media/video_writer.hpp"

#include <csignal>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "render/media/png_file.hpp"
#include "tests/unit/render/decoded_video.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 160;
constexpr int kHeight = 96;
constexpr int kFps = 10;

// A plain colour with a bar that moves, so that frames differ.
Image test_image(int index) {
  Image image{kWidth, kHeight, {}};
  image.rgb.resize(3 * kWidth * kHeight);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = 200;
    image.rgb[i + 1] = 60;
    image.rgb[i + 2] = 30;
  }
  Canvas(image).fill_rectangle({3.0 * index, 60.0, 20.0, 30.0}, {0.1F, 0.3F, 0.9F});
  return image;
}

template <typename Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

TEST(video_writer, finished_video_is_whole_and_alone) {
  const auto folder = fresh_folder();
  const std::string path = folder / "a:b video.mp4";  // neither a protocol nor two words
  VideoWriter video(path, kWidth, kHeight, kFps);
  for (int i = 0; i < 25; ++i) {
    video.add(test_image(i));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  video.finish();

  const DecodedVideo decoded = decode_video("file:" + path);
  EXPECT_EQ(decoded.codec, "h264");
  EXPECT_EQ(decoded.width, kWidth);
  EXPECT_EQ(decoded.height, kHeight);
  EXPECT_EQ(decoded.frames, 25);
  EXPECT_NEAR(decoded.duration, 2.5, 1e-3);  // the container counts milliseconds
  EXPECT_TRUE(decoded.bt709);
  // 8-bit limited range and lossy coding: a few of 255.
  EXPECT_LT(colour_difference(pixel_at(decoded.first, {80.0, 20.0}),
                              {200.0F / 255.0F, 60.0F / 255.0F, 30.0F / 255.0F}),
            8);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) {
    ++files;
  }
  EXPECT_EQ(files, 1);
}

TEST(video_writer, index_of_a_finished_video_comes_before_its_pictures) {
  const std::string path = fresh_folder() / "video.mp4";
  VideoWriter video(path, kWidth, kHeight, kFps);
  video.add(test_image(0));
  video.finish();
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
  EXPECT_EQ(bytes.find("moof"), std::string::npos);  // no fragments
}

TEST(video_writer, unfinished_video_leaves_a_playable_partial_and_nothing_under_its_name) {
  const std::string path = fresh_folder() / "video.mp4";
  {
    VideoWriter video(path, kWidth, kHeight, kFps);
    for (int i = 0; i < 7; ++i) {
      video.add(test_image(i));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(decode_video(path + ".partial").frames, 7);
}

TEST(video_writer, killed_process_leaves_a_playable_partial_and_nothing_under_its_name) {
  const std::string path = fresh_folder() / "video.mp4";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    VideoWriter video(path, kWidth, kHeight, kFps);
    for (int i = 0; i < 120; ++i) {
      video.add(test_image(i % 40));
    }
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(std::filesystem::exists(path));
  // What the encoder looks ahead (four seconds at most) and the open fragment are lost.
  EXPECT_GE(decode_video(path + ".partial").frames, 60);
}

TEST(video_writer, refuses_odd_sizes) {
  const std::string path = fresh_folder() / "video.mp4";
  EXPECT_THROW(VideoWriter(path, 161, 96, kFps), std::invalid_argument);
  EXPECT_THAT(error_of([&] { VideoWriter(path, 160, 97, kFps); }), HasSubstr("160x97"));
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(video_writer, refuses_frames_of_another_size) {
  VideoWriter video(fresh_folder() / "video.mp4", kWidth + 2, kHeight, kFps);
  EXPECT_THROW(video.add(test_image(0)), std::invalid_argument);
}

TEST(video_writer, folder_that_does_not_exist_is_named_with_the_systems_words) {
  const std::string path = fresh_folder() / "missing" / "video.mp4";
  const std::string error = error_of([&] { VideoWriter(path, kWidth, kHeight, kFps); });
  EXPECT_THAT(error, HasSubstr(path));
  EXPECT_THAT(error, HasSubstr("No such file or directory"));
}

TEST(video_writer, unknown_preset_is_an_error) {
  const std::string path = fresh_folder() / "video.mp4";
  EXPECT_THROW(VideoWriter(path, kWidth, kHeight, kFps, {.preset = "no such preset"}),
               std::runtime_error);
}

TEST(video_writer, file_that_cannot_grow_is_an_error_and_leaves_nothing_under_its_name) {
  const std::string path = fresh_folder() / "video.mp4";
  // In a process of its own: a limit on the size of files stands in for a full disk.
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = error_of([&] {
      VideoWriter video(path, kWidth, kHeight, kFps);
      for (int i = 0; i < 200; ++i) {
        video.add(test_image(i % 40));
      }
      video.finish();
    });
    const bool told =
        error.find(path) != std::string::npos && error.find("File too large") != std::string::npos;
    _exit(told ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(video_writer, finishing_without_frames_is_an_error) {
  const std::string path = fresh_folder() / "video.mp4";
  VideoWriter video(path, kWidth, kHeight, kFps);
  EXPECT_THROW(video.finish(), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(png_file, keeps_every_pixel) {
  const std::string path = fresh_folder() / "picture.png";
  const Image image = test_image(3);
  write_png(path, image);
  EXPECT_EQ(decode_video(path).first.rgb, image.rgb);
}

TEST(png_file, errors_name_the_path) {
  const std::string path = fresh_folder() / "missing" / "picture.png";
  const std::string error = error_of([&] { write_png(path, test_image(0)); });
  EXPECT_THAT(error, HasSubstr(path));
  EXPECT_THAT(error, HasSubstr("No such file or directory"));
  EXPECT_THROW(write_png(path, Image{}), std::invalid_argument);
}

}  // namespace
}  // namespace qsmpc
