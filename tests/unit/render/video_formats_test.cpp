#include <algorithm>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/video/video_file.hpp"
#include "render/media/gif_palette.hpp"
#include "tests/unit/render/decoded_video.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace video_formats_test {

using ::testing::HasSubstr;

constexpr int kWidth = 160;
constexpr int kHeight = 96;
constexpr int kFps = 10;
constexpr Colour kGround{0.8F, 0.25F, 0.1F};
constexpr Colour kBar{0.1F, 0.3F, 0.9F};

// A plain colour with a moving bar, so that frames differ.
Image test_image(int index) {
  Image image{kWidth, kHeight, {}};
  image.rgb.resize(3 * kWidth * kHeight);
  Canvas(image).fill_rectangle({0.0, 0.0, kWidth, kHeight}, kGround);
  Canvas(image).fill_rectangle({3.0 * index, 60.0, 20.0, 30.0}, kBar);
  return image;
}

VideoSettings settings(VideoFormat format, int quality = kUsualQuality) {
  return {.format = format,
          .width = kWidth,
          .height = kHeight,
          .frames_per_second = kFps,
          .quality = quality};
}

void write_video(const std::string& path, int frames, const VideoSettings& wanted) {
  harness::VideoFile video(path, wanted);
  for (int i = 0; i < frames; ++i) {
    video.add(test_image(i % 40));
  }
  video.finish();
}

void write_video(const std::string& path, int frames) {
  write_video(path, frames, settings(known_video_format(path)));
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

int files_in(const std::filesystem::path& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder),
                                        std::filesystem::directory_iterator()));
}

// FFmpeg 5 writes animated WebP but cannot read it: facts from its chunks.
struct WebpFacts {
  int width = 0;
  int height = 0;
  int loops = -1;  // 0: forever
  int pictures = 0;
  int milliseconds = 0;
};

int number_at(const std::string& bytes, std::size_t place, std::size_t size) {
  int value = 0;
  for (std::size_t i = size; i-- > 0;) {
    value = 256 * value + static_cast<unsigned char>(bytes.at(place + i));
  }
  return value;
}

WebpFacts webp_facts(const std::string& bytes) {
  WebpFacts facts;
  EXPECT_EQ(bytes.substr(0, 4), "RIFF");
  EXPECT_EQ(bytes.substr(8, 4), "WEBP");
  EXPECT_EQ(static_cast<std::size_t>(number_at(bytes, 4, 4)) + 8, bytes.size());
  for (std::size_t place = 12; place + 8 <= bytes.size();) {
    const std::string name = bytes.substr(place, 4);
    const int size = number_at(bytes, place + 4, 4);
    const std::size_t data = place + 8;
    if (name == "VP8X") {
      facts.width = number_at(bytes, data + 4, 3) + 1;
      facts.height = number_at(bytes, data + 7, 3) + 1;
    } else if (name == "ANIM") {
      facts.loops = number_at(bytes, data + 4, 2);
    } else if (name == "ANMF") {
      ++facts.pictures;
      facts.milliseconds += number_at(bytes, data + 12, 3);
    }
    place = data + static_cast<std::size_t>(size + size % 2);
  }
  return facts;
}

TEST(video_formats, webm_is_vp9_and_whole) {
  const auto folder = fresh_folder();
  write_video(folder / "video.webm", 25);
  const DecodedVideo video = decode_video(folder / "video.webm");
  EXPECT_THAT(video.codec, HasSubstr("vp9"));
  EXPECT_EQ(video.width, kWidth);
  EXPECT_EQ(video.height, kHeight);
  EXPECT_EQ(video.frames, 25);
  EXPECT_NEAR(video.duration, 2.5, 1e-3);  // the container uses milliseconds
  EXPECT_TRUE(video.bt709);
  // 8-bit limited range and lossy coding: a few of 255.
  EXPECT_LT(colour_difference(pixel_at(video.first, {80.0, 20.0}), kGround), 8);
  EXPECT_EQ(files_in(folder), 1);
}

TEST(video_formats, index_of_a_finished_webm_comes_before_its_pictures) {
  const std::string path = fresh_folder() / "video.webm";
  write_video(path, 12);
  const std::string bytes = bytes_of(path);
  const std::size_t cues = bytes.find("\x1C\x53\xBB\x6B", 200);  // after the table of contents
  const std::size_t cluster = bytes.find("\x1F\x43\xB6\x75", 200);
  ASSERT_NE(cues, std::string::npos);
  ASSERT_NE(cluster, std::string::npos);
  EXPECT_LT(cues, cluster);
}

TEST(video_formats, killed_process_leaves_a_playable_webm) {
  const std::string path = fresh_folder() / "video.webm";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    harness::VideoFile video(path, settings(known_video_format(path)));
    for (int i = 0; i < 60; ++i) {
      video.add(test_image(i % 40));
    }
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(std::filesystem::exists(path));
  // The open cluster of one second is lost.
  EXPECT_GE(decode_video(path + ".partial").frames, 48);
}

TEST(video_formats, gif_shows_every_frame_in_its_colours) {
  const auto folder = fresh_folder();
  write_video(folder / "video.gif", 12);
  const DecodedVideo video = decode_video(folder / "video.gif");
  EXPECT_EQ(video.codec, "gif");
  EXPECT_EQ(video.width, kWidth);
  EXPECT_EQ(video.height, kHeight);
  EXPECT_EQ(video.frames, 12);
  EXPECT_NEAR(video.duration, 1.2, 1e-2);  // the container uses hundredths
  // Two colours and a few blends between them: the palette has them all.
  EXPECT_LE(colour_difference(pixel_at(video.first, {80.0, 20.0}), kGround), 2);
  EXPECT_LE(colour_difference(pixel_at(video.first, {10.0, 75.0}), kBar), 2);
  EXPECT_THAT(bytes_of(folder / "video.gif"), HasSubstr("NETSCAPE2.0"));  // loops forever
  EXPECT_EQ(files_in(folder), 1);
}

TEST(video_formats, webp_shows_every_frame_for_its_time) {
  const auto folder = fresh_folder();
  write_video(folder / "video.webp", 12);
  const WebpFacts facts = webp_facts(bytes_of(folder / "video.webp"));
  EXPECT_EQ(facts.width, kWidth);
  EXPECT_EQ(facts.height, kHeight);
  EXPECT_EQ(facts.loops, 0);
  EXPECT_EQ(facts.pictures, 12);
  EXPECT_NEAR(facts.milliseconds, 1200, 12);  // each picture's time is rounded
  EXPECT_EQ(files_in(folder), 1);
}

TEST(video_formats, killed_process_leaves_a_playable_video_beside_a_gif) {
  const std::string path = fresh_folder() / "video.gif";
  {
    harness::VideoFile video(path, settings(known_video_format(path)));
    for (int i = 0; i < 7; ++i) {
      video.add(test_image(i));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(decode_video(path + ".partial").frames, 7);
}

TEST(video_formats, format_follows_the_ending_unless_it_is_given) {
  const auto folder = fresh_folder();
  write_video(folder / "one.WEBM", 3);
  write_video(folder / "two.bin", 3, settings(VideoFormat::kMp4));
  EXPECT_THAT(decode_video(folder / "one.WEBM").codec, HasSubstr("vp9"));
  EXPECT_EQ(decode_video(folder / "two.bin").codec, "h264");
}

TEST(video_formats, unknown_endings_are_refused_with_the_known_ones) {
  const std::string path = fresh_folder() / "video.avi";
  try {
    write_video(path, 1);
    FAIL() << "it was written";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("video.avi"));
    EXPECT_THAT(error.what(), HasSubstr(".mp4, .webm, .gif, .webp"));
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(video_formats, qualities_out_of_range_and_gifs_too_fast_are_refused) {
  const auto folder = fresh_folder();
  for (const int quality : {-1, 101}) {
    EXPECT_THROW(write_video(folder / "a.mp4", 1, settings(VideoFormat::kMp4, quality)),
                 std::invalid_argument);
  }
  VideoSettings fast = settings(VideoFormat::kGif);
  fast.frames_per_second = 51;
  EXPECT_THROW(write_video(folder / "a.gif", 1, fast), std::invalid_argument);
  EXPECT_EQ(files_in(folder), 0);
}

class EveryFormat : public ::testing::TestWithParam<std::string> {};

// Smooth noise, which is expensive to encode.
Image noisy_image(int index) {
  Image image = test_image(index);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const auto wave = static_cast<int>(i * i / 977 + static_cast<std::size_t>(41 * index)) % 64;
    image.rgb[i] = static_cast<unsigned char>(image.rgb[i] / 2 + wave);
  }
  return image;
}

TEST_P(EveryFormat, lower_quality_is_a_smaller_file) {
  const auto folder = fresh_folder();
  std::vector<std::uintmax_t> sizes;
  for (const int quality : {10, 60}) {
    const std::string path = folder / (std::to_string(quality) + "." + GetParam());
    harness::VideoFile video(path, settings(known_video_format(path), quality));
    for (int i = 0; i < 6; ++i) {
      video.add(noisy_image(i));
    }
    video.finish();
    sizes.push_back(std::filesystem::file_size(path));
  }
  EXPECT_LT(sizes[0], 0.9 * static_cast<double>(sizes[1]));
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, ::testing::ValuesIn(video_format_names()));

TEST(gif_palette, holds_no_more_colours_than_asked_for_and_the_frequent_ones) {
  ColourCount count;
  std::vector<unsigned char> rgba;
  for (int i = 0; i < 64 * 64; ++i) {
    const bool plain = i % 2 == 0;
    const auto value = static_cast<unsigned char>(plain ? 200 : i % 256);
    rgba.insert(rgba.end(), {value, static_cast<unsigned char>(plain ? 30 : i / 16), 90, 255});
  }
  count.add(rgba, 64, 64);
  const std::vector<std::uint32_t> palette = count.best(16);
  EXPECT_LE(palette.size(), 16U);
  PaletteMap map(palette);
  const std::array<unsigned char, 3> plain{200, 30, 90};
  const std::uint32_t found = palette.at(map.index(plain.data(), 0, 0));
  EXPECT_NEAR(static_cast<int>(found >> 16U & 0xffU), 200, 4);
  EXPECT_NEAR(static_cast<int>(found >> 8U & 0xffU), 30, 4);
}

TEST(gif_palette, a_colour_that_is_missing_is_mixed_from_its_neighbours) {
  PaletteMap map({0xff646464U, 0xff6c6c6cU});
  const std::array<unsigned char, 3> between{104, 104, 104};
  std::set<int> used;
  double sum = 0.0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const int index = map.index(between.data(), x, y);
      used.insert(index);
      sum += index;
    }
  }
  EXPECT_EQ(used.size(), 2U);
  EXPECT_NEAR(sum / 256.0, 0.5, 0.2);
}

}  // namespace video_formats_test
}  // namespace qsmpc::render
