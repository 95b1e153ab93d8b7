#include "render/media/video_writer.hpp"

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/video/video_file.hpp"
#include "render/media/png_image.hpp"
#include "tests/unit/render/decoded_video.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace video_writer_test {

using ::testing::HasSubstr;

constexpr int kWidth = 160;
constexpr int kHeight = 96;
constexpr int kFps = 10;

// A plain colour with a moving bar, so that frames differ.
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

VideoSettings settings(int width = kWidth, int height = kHeight) {
  return {.width = width, .height = height, .frames_per_second = kFps};
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
  harness::VideoFile video(path, settings());
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
  EXPECT_NEAR(decoded.duration, 2.5, 1e-3);  // the container uses milliseconds
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
  harness::VideoFile video(path, settings());
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
    harness::VideoFile video(path, settings());
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
    harness::VideoFile video(path, settings());
    for (int i = 0; i < 120; ++i) {
      video.add(test_image(i % 40));
    }
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(std::filesystem::exists(path));
  // The encoder's look-ahead (at most four seconds) and the open fragment are lost.
  EXPECT_GE(decode_video(path + ".partial").frames, 60);
}

TEST(video_writer, refuses_odd_sizes) {
  const std::string path = fresh_folder() / "video.mp4";
  EXPECT_THROW(harness::VideoFile(path, settings(161, 96)), std::invalid_argument);
  EXPECT_THAT(error_of([&] { harness::VideoFile(path, settings(160, 97)); }), HasSubstr("160x97"));
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(video_writer, refuses_frames_of_another_size) {
  harness::VideoFile video(fresh_folder() / "video.mp4", settings(kWidth + 2, kHeight));
  EXPECT_THROW(video.add(test_image(0)), std::invalid_argument);
}

TEST(video_writer, folder_that_does_not_exist_is_named_with_the_systems_message) {
  const std::string path = fresh_folder() / "missing" / "video.mp4";
  const std::string error = error_of([&] { harness::VideoFile(path, settings()); });
  EXPECT_THAT(error, HasSubstr(path));
  EXPECT_THAT(error, HasSubstr("No such file or directory"));
}

TEST(video_writer, unknown_preset_is_an_error) {
  const std::string path = fresh_folder() / "video.mp4";
  VideoSettings wanted = settings();
  wanted.preset = "no such preset";
  EXPECT_THROW(harness::VideoFile(path, wanted), std::runtime_error);
}

TEST(video_writer, file_that_cannot_grow_is_an_error_and_leaves_nothing_under_its_name) {
  const std::string path = fresh_folder() / "video.mp4";
  // In its own process: a file size limit stands in for a full disk.
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = error_of([&] {
      harness::VideoFile video(path, settings());
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
  harness::VideoFile video(path, settings());
  EXPECT_THROW(video.finish(), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

// Bytes in memory; writing fails beyond a certain number of bytes.
class MemoryFile final : public ByteFile {
 public:
  explicit MemoryFile(std::int64_t room = 1 << 24) : room_(room) {}

  void clear() override { bytes_.clear(); }
  std::int64_t size() override { return static_cast<std::int64_t>(bytes_.size()); }
  void write_at(std::int64_t position, std::span<const std::uint8_t> bytes) override {
    const auto end = static_cast<std::size_t>(position) + bytes.size();
    if (end > static_cast<std::size_t>(room_)) throw harness::IoError("no room in memory");
    bytes_.resize(std::max(bytes_.size(), end));
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + position);
  }
  std::size_t read_at(std::int64_t position, std::span<std::uint8_t> out) override {
    const auto count = std::min<std::int64_t>(size() - position, static_cast<int>(out.size()));
    std::copy_n(bytes_.begin() + position, std::max<std::int64_t>(count, 0), out.begin());
    return static_cast<std::size_t>(std::max<std::int64_t>(count, 0));
  }

  [[nodiscard]] std::string_view bytes() const {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

 private:
  std::int64_t room_;
  std::vector<std::uint8_t> bytes_;
};

class EveryKeptFormat : public ::testing::TestWithParam<VideoFormat> {};

TEST_P(EveryKeptFormat, needs_no_file_system) {
  MemoryFile partial;
  MemoryFile finished;
  VideoSettings wanted = settings();
  wanted.format = GetParam();
  {
    VideoWriter video(partial, wanted);
    for (int i = 0; i < 12; ++i) video.add(test_image(i));
    video.finish(finished);
  }
  const std::string path = fresh_folder() / ("video." + video_format_name(GetParam()));
  harness::write_file(path, finished.bytes());
  // FFmpeg 5 writes animated WebP but cannot read it.
  if (GetParam() != VideoFormat::kWebp) {
    EXPECT_EQ(decode_video(path).frames, 12);
  }
  EXPECT_GT(finished.size(), 100);
}

TEST_P(EveryKeptFormat, what_a_file_throws_reaches_the_caller) {
  VideoSettings wanted = settings();
  wanted.format = GetParam();
  for (const std::int64_t room : {10, 3000}) {
    MemoryFile full(room);
    MemoryFile enough;
    const auto write = [&](ByteFile& partial, ByteFile& finished) {
      VideoWriter video(partial, wanted);
      for (int i = 0; i < 40; ++i) video.add(test_image(i));
      video.finish(finished);
    };
    EXPECT_THAT(error_of([&] { write(full, enough); }), HasSubstr("no room in memory")) << room;
    // FFmpeg 5's own GIF writer leaks a packet if the file is full.
    if (GetParam() == VideoFormat::kGif) continue;
    MemoryFile narrow(room / 10);
    EXPECT_THROW(write(enough, narrow), harness::IoError) << room;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryKeptFormat,
                         ::testing::Values(VideoFormat::kMp4, VideoFormat::kWebm, VideoFormat::kGif,
                                           VideoFormat::kWebp));

TEST(png_image, keeps_every_pixel) {
  const std::string path = fresh_folder() / "picture.png";
  const Image image = test_image(3);
  harness::write_file(path, encode_png(image));
  EXPECT_EQ(decode_video(path).first.rgb, image.rgb);
}

TEST(png_image, refuses_data_that_do_not_fit_the_size) {
  EXPECT_THROW((void)encode_png(Image{}), std::invalid_argument);
  Image image = test_image(0);
  image.rgb.pop_back();
  EXPECT_THROW((void)encode_png(image), std::invalid_argument);
}

}  // namespace video_writer_test
}  // namespace qsmpc::render
