#include "harness/video/video_timings.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace video_timings_test {

std::string written(const testing::TemporaryFolder& folder, const std::string& text) {
  std::string path = folder / "video.json";
  std::ofstream(path) << text;
  return path;
}

TEST(video_timings, are_read_as_they_were_written) {
  const testing::TemporaryFolder folder;
  const VideoTimings timings{.frames = 90,
                             .fps = 30,
                             .from = 1.5,
                             .speed = 0.25,
                             .width = 640,
                             .height = 360,
                             .codec = "h264",
                             .wall_s = 2.0,
                             .drawing_ms = 20.5,
                             .encoding_ms = 9.25,
                             .simulation_ms = 0.5,
                             .gl = "a library"};
  const VideoTimings read = read_video_timings(written(folder, video_json(timings)));
  EXPECT_EQ(video_json(read), video_json(timings));
  EXPECT_EQ(read.from, 1.5);
  EXPECT_EQ(read.speed, 0.25);
}

TEST(video_timings, a_file_of_another_kind_is_refused_by_name) {
  const testing::TemporaryFolder folder;
  std::string stands_still = video_json({.frames = 1, .fps = 1, .speed = 0.0});
  for (const std::string& text : {std::string(), std::string("{"), std::string("[]"),
                                  std::string("{\"frames\": \"x\"}"), stands_still}) {
    EXPECT_THROW((void)read_video_timings(written(folder, text)), InputError) << text;
  }
  EXPECT_THROW((void)read_video_timings(folder / "none.json"), InputError);
  std::filesystem::create_directory(folder / "folder.json");
  EXPECT_THROW((void)read_video_timings(folder / "folder.json"), InputError);
}

}  // namespace video_timings_test
}  // namespace qsmpc::harness
