// `qsmpc render` from the outside: the files that it writes, as reported by ffprobe, and what it
// refuses.

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/threads/sanitizers.hpp"
#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace render_test {

using namespace testing;

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> small_run(const std::string& out) {
  return {"run",   "dubins_obstacles",
          "--set", "controller.horizon=3",
          "--set", "controller.quantisation={state: 9, noise: 9, compressed: 9}",
          "--set", "limit.steps=6",
          "--set", "video.size=320x180",
          "--set", "video.fps=10",
          "--out", out};
}

/// ffprobe's description of the video stream, "codec,width,height,frames".
std::string probe(const std::string& video) {
  const std::string command =
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=codec_name,width,height,nb_read_frames -of csv=p=0 '" +
      video + "' 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 256> buffer{};
  while (pipe != nullptr && fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) {
    text += buffer.data();
  }
  while (!text.empty() && (text.back() == '\n' || text.back() == ',')) text.pop_back();
  return text;
}

/// An episode of 0.6 s without a video.
class Render : public ::testing::Test {
 protected:
  Render() {
    std::vector<std::string> arguments = small_run(episode());
    arguments.insert(arguments.end(), {"--no-video", "--quiet"});
    EXPECT_EQ(run_qsmpc(arguments).exit_code, 0);
  }

  [[nodiscard]] std::string episode() const { return folder_ / "episode"; }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  [[nodiscard]] ProcessResult render(const std::vector<std::string>& more,
                                     const ProcessOptions& options = {}) const {
    std::vector<std::string> arguments{"render", episode()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_qsmpc(arguments, options);
  }

  /// Renders into a file of this name and probes it.
  [[nodiscard]] std::string probed(const std::string& name,
                                   const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"--out", path(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, path(name) + "\n");
    return probe(path(name));
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Render, writes_the_format_that_the_ending_asks_for) {
  // 0.6 s plus one second for the outcome.
  EXPECT_EQ(probed("a.mp4", {}), "h264,320,180,16");
  EXPECT_EQ(probed("a.webm", {}), "vp9,320,180,16");
  EXPECT_EQ(probed("a.gif", {}), "gif,640,360,20");  // at 12 frames per second
  EXPECT_EQ(probed("b.gif", {"--size", "160x90", "--fps", "5"}), "gif,160,90,8");
  EXPECT_EQ(probed("a.film", {"--format", "webm", "--size", "160x90"}), "vp9,160,90,16");
}

TEST_F(Render, webp_is_an_animation_of_the_size_of_a_picture) {
  const ProcessResult result = render({"--format", "webp", "--size", "64x64"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output, episode() + "/episode.webp\n");
  const std::string bytes = read_text(episode() + "/episode.webp");
  EXPECT_THAT(bytes, StartsWith("RIFF"));
  EXPECT_THAT(bytes, HasSubstr("ANIM"));
}

TEST_F(Render, shows_a_part_at_another_speed) {
  EXPECT_EQ(probed("fast.mp4", {"--speed", "2"}), "h264,320,180,13");
  EXPECT_EQ(probed("part.mp4", {"--from", "0.1", "--to", "0.4"}), "h264,320,180,3");
  EXPECT_EQ(probed("slow.mp4", {"--from", "0.1", "--to", "0.4", "--speed", "0.5"}),
            "h264,320,180,6");
}

TEST_F(Render, an_interrupt_leaves_the_video_that_was_there) {
  ASSERT_EQ(render({}).exit_code, 0);
  const std::string video = episode() + "/episode.mp4";
  const std::string bytes = read_text(video);
  const std::string numbers = read_text(episode() + "/video.json");
  std::vector<std::string> arguments{"render", episode(), "--size", "1280x720", "--fps", "240"};
  const ProcessResult result = run_qsmpc(arguments, {.meanwhile = [&](pid_t process) {
                                           if (!std::filesystem::exists(video + ".partial")) {
                                             return false;
                                           }
                                           kill(process, SIGINT);
                                           return true;
                                         }});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.output, "");
  EXPECT_THAT(result.errors, HasSubstr("qsmpc: interrupted: " + video + " is unchanged\n"));
  EXPECT_EQ(read_text(video), bytes);
  EXPECT_EQ(read_text(episode() + "/video.json"), numbers);
  EXPECT_FALSE(std::filesystem::exists(video + ".partial"));
}

TEST_F(Render, a_still_is_a_png_of_the_size_asked_for) {
  const ProcessResult result = render({"--still", "0.25", "--verbose"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output, episode() + "/still-0.25.png\n");
  EXPECT_THAT(probe(episode() + "/still-0.25.png"), StartsWith("png,320,180"));
  EXPECT_THAT(result.errors, HasSubstr("OpenGL: osmesa: "));
  EXPECT_THAT(probed("s.png", {"--still", "0.6", "--size", "400x200"}), StartsWith("png,400,200"));
}

// The address sanitizer reserves terabytes for its shadow memory before the program starts.
#if !QSMPC_ADDRESS_SANITIZER
TEST_F(Render, too_little_address_space_is_reported_in_one_line) {
  for (const long limit : {450'000'000L, 500'000'000L, 600'000'000L, 800'000'000L}) {
    const ProcessOptions options{.address_space = limit};
    for (const ProcessResult& result :
         {render({"--quiet"}, options), run_qsmpc(small_run(path("none")), options)}) {
      EXPECT_EQ(result.exit_code, 3) << limit;
      EXPECT_THAT(result.errors, ContainsRegex("^qsmpc: drawing 320x180 pixels on 2 threads takes "
                                               "about [0-9]+ MB of address space, but the process "
                                               "limit .ulimit -v. leaves [0-9]+ MB\n$"));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path("none")));
  const ProcessResult enough = render({"--quiet"}, {.address_space = 3'000'000'000L});
  EXPECT_EQ(enough.exit_code, 0) << enough.errors;
}
#endif

TEST_F(Render, says_what_drew_and_what_it_cost) {
  const ProcessResult result = render({"--verbose", "--quiet", "--gl", "egl"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("OpenGL: egl: "));
  EXPECT_THAT(result.errors, HasSubstr("video: 16 frames in "));
  const auto numbers = nlohmann::json::parse(read_text(episode() + "/video.json"));
  EXPECT_EQ(numbers["frames"], 16);
  EXPECT_EQ(numbers["fps"], 10);
  EXPECT_EQ(numbers["codec"], "h264");
  EXPECT_DOUBLE_EQ(numbers["seconds"], 1.6);
  EXPECT_GT(numbers["simulation_ms"], 0.0);
  EXPECT_THAT(std::string(numbers["gl"]), StartsWith("egl: "));
  // Numbers for another file are written separately.
  (void)probed("a.mp4", {});
  EXPECT_EQ(nlohmann::json::parse(read_text(path("a.mp4.json")))["frames"], 16);
}

TEST_F(Render, wrong_values_are_refused_in_one_line) {
  const auto refused = [this](const std::vector<std::string>& arguments, const std::string& key,
                              const std::string& expected) {
    const ProcessResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 2) << key;
    EXPECT_THAT(result.errors, HasSubstr(key));
    EXPECT_THAT(result.errors, HasSubstr(expected));
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  };
  refused({"--out", path("a.avi")}, "--out", "ends with .mp4, .webm, .gif, .webp");
  refused({"--format", "avi"}, "--format", "avi");
  refused({"--size", "33x20"}, "--size", "even numbers");
  refused({"--speed", "0.01"}, "--speed", "0.1");
  refused({"--quality", "101"}, "--quality", "100");
  refused({"--from", "-1"}, "--from", "from 0 s to 0.6 s");
  refused({"--from", "0.4", "--to", "0.2"}, "--to", "from 0.4 s to 0.6 s");
  refused({"--still", "7"}, "--still", "from 0 s to 0.6 s");
  refused({"--still", "0.1", "--out", path("a.jpg")}, "--out", ".png");
  refused({"--out", path("a.gif"), "--fps", "60"}, "--fps", "at most 50");
  refused({"--gl", "vulkan"}, "--gl", "osmesa");
  EXPECT_THAT(files_in(episode()), Not(::testing::Contains("video.json")));
}

/// As if neither library were installed: invalid files take their place.
class WithoutOpenGl : public Render {
 protected:
  WithoutOpenGl() {
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so", "libEGL.so.1", "libEGL.so"}) {
      (void)none_.file(name, "");
    }
    setenv("LD_LIBRARY_PATH", none_.path().c_str(), 1);
  }
  ~WithoutOpenGl() override { unsetenv("LD_LIBRARY_PATH"); }

 private:
  TemporaryFolder none_;
};

TEST_F(WithoutOpenGl, rendering_says_what_to_install) {
  const ProcessResult result = render({"--quiet"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("libOSMesa.so.8, libOSMesa.so, libEGL.so.1, libEGL.so"));
  EXPECT_THAT(result.errors, HasSubstr("install OSMesa"));
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
}

TEST_F(WithoutOpenGl, all_else_of_a_run_works) {
  const std::string out = path("run");
  const ProcessResult result = run_qsmpc(small_run(out));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("no video: off-screen rendering"));
  EXPECT_THAT(files_in(out),
              ::testing::IsSupersetOf({"episode.h5", "summary.json", "report.html"}));
  EXPECT_THAT(files_in(out), Not(::testing::Contains("episode.mp4")));
}

}  // namespace render_test
}  // namespace qsmpc::harness
