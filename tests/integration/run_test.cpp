// `qsmpc run` from the outside: exit codes, lines on standard error, files left behind.

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/trace/trace_file.hpp"
#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace run_test {

using namespace testing;

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

std::vector<std::string> small_run(const std::string& out, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {
      "run",   "dubins_obstacles",
      "--set", "controller.horizon=4",
      "--set", "controller.quantisation={state: 16, noise: 16, compressed: 16}",
      "--set", "limit.steps=6",
      "--set", "video.size=320x180",
      "--set", "video.fps=10",
      "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

bool exists(const std::string& path) { return std::filesystem::exists(path); }

/// The number of unfinished files in `folder`.
int partial_files(const std::string& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".partial") ++count;
  }
  return count;
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
  return text;
}

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Run, leaves_all_its_files_and_needs_no_display) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/new/folder";
  const ProcessResult result = run_qsmpc(
      small_run(out), {.folder = folder.path(), .unset = {"DISPLAY", "MUJOCO_GL", "HOME"}});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  for (const char* file :
       {"episode.h5", "summary.json", "scenario.yaml", "episode.mp4", "report.html"}) {
    EXPECT_TRUE(exists(out + "/" + file)) << file;
  }
  EXPECT_EQ(partial_files(out), 0);
  EXPECT_FALSE(exists(folder.path() + "/MUJOCO_LOG.TXT"));
  EXPECT_THAT(result.output, HasSubstr(out + "/episode.mp4"));
  EXPECT_THAT(probe(out + "/episode.mp4"), ::testing::StartsWith("h264,320,180,"));

  const auto summary = nlohmann::json::parse(read_text(out + "/summary.json"));
  EXPECT_EQ(summary["scenario"], "dubins_obstacles");
  EXPECT_EQ(summary["outcome"], "timeout");
  EXPECT_EQ(summary["steps"], 6);
  EXPECT_EQ(summary["video"], "episode.mp4");
  EXPECT_EQ(read_trace(out + "/episode.h5").steps.size(), 6U);
}

TEST(Run, without_video_makes_none) {
  const TemporaryFolder folder;
  const ProcessResult result = run_qsmpc(small_run(folder.path(), {"--no-video", "--quiet"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.errors, "");
  EXPECT_FALSE(exists(folder.path() + "/episode.mp4"));
  EXPECT_TRUE(nlohmann::json::parse(read_text(folder.path() + "/summary.json"))["video"].is_null());
}

TEST(Run, prints_its_summary_as_json) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_qsmpc(small_run(folder.path(), {"--no-video", "--quiet", "--json", "--seed", "12"}));
  EXPECT_EQ(result.output, read_text(folder.path() + "/summary.json"));
  EXPECT_EQ(nlohmann::json::parse(result.output)["seed"], 12);
}

TEST(Run, the_resolved_scenario_runs_again_to_the_same_trace) {
  const TemporaryFolder folder;
  const std::string first = folder.path() + "/first";
  const std::string second = folder.path() + "/second";
  ASSERT_EQ(run_qsmpc(small_run(first, {"--no-video", "--seed", "5"})).exit_code, 0);
  ASSERT_EQ(run_qsmpc({"run", first + "/scenario.yaml", "--no-video", "--out", second}).exit_code,
            0);
  EXPECT_EQ(read_text(first + "/scenario.yaml"), read_text(second + "/scenario.yaml"));
  const Trace a = read_trace(first + "/episode.h5");
  const Trace b = read_trace(second + "/episode.h5");
  ASSERT_EQ(a.steps.size(), b.steps.size());
  EXPECT_EQ(a.final_state, b.final_state);
  EXPECT_EQ(a.seed, b.seed);
}

TEST(Run, drives_past_shapes_within_its_limit_of_the_risk) {
  const TemporaryFolder folder;
  const ProcessResult result = run_qsmpc(
      {"run", "dubins_obstacles", "--no-video", "--quiet", "--json", "--out", folder.path(),
       "--set", "plant.kind=analytic", "--set",
       "safe_set.obstacles=[{box: {centre: [3, 3], size: [2, 1.6], angle: 0.5}}, {disc: {centre: "
       "[7, 6.5], radius: 1}}, {polygon: [[9, 2], [12, 2], [12, 5], [10.5, 3.5], [9, 5]]}, "
       "{half_plane: {normal: [-1, 1], offset: 6}}]"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto summary = nlohmann::json::parse(result.output);
  EXPECT_EQ(summary["outcome"], "reached");
  EXPECT_EQ(summary["collision"], false);
  EXPECT_GT(summary["min_clearance"], 0.0);
  EXPECT_LE(summary["risk"]["plan"]["certified_max"], 0.02);
  EXPECT_GT(summary["certificate"]["next_step"]["max"], 0.0);
  EXPECT_THAT(read_text(folder.path() + "/scenario.yaml"),
              HasSubstr("- {box: {centre: [3, 3], size: [2, 1.6], angle: 0.5}}"));
}

TEST(Run, fails_on_an_outcome_of_fail_on) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_qsmpc(small_run(folder.path(), {"--no-video", "--fail-on", "timeout"})).exit_code,
            1);
  EXPECT_EQ(
      run_qsmpc(small_run(folder.path(), {"--no-video", "--fail-on", "collision,fault"})).exit_code,
      0);
}

TEST(Run, fails_on_an_exceeded_risk_limit_if_asked) {
  const TemporaryFolder folder;
  const auto exit_code = [&](const char* risk, const char* fail_on) {
    return run_qsmpc(small_run(folder.path(), {"--no-video", "--force", "--set",
                                               std::string("risk=") + risk, "--fail-on", fail_on}))
        .exit_code;
  };
  constexpr const char* kNever = "{plan: 0}";  // no certificate is 0
  EXPECT_EQ(exit_code(kNever, "risk_exceeded"), 1);
  EXPECT_EQ(exit_code(kNever, "collision,left_bounds,fault"), 0);
  EXPECT_EQ(exit_code("{mission: 0}", "risk_exceeded"), 1);
  EXPECT_EQ(exit_code("{plan: 1}", "risk_exceeded"), 0);
  EXPECT_EQ(exit_code("{}", "risk_exceeded"), 0);
}

TEST(Run, an_unsafe_drive_exits_with_failure_unless_told_otherwise) {
  const TemporaryFolder folder;
  const auto exit_code = [&](const char* safe_set, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"--no-video", "--force",
                                          "--set",      std::string("safe_set=") + safe_set,
                                          "--set",      "limit.steps=20",
                                          "--set",      "controller.penalty={box: 0, obstacle: 0}",
                                          "--set",      "target.state=[3, 0, 0]",
                                          "--set",      "plant.kind=analytic",
                                          "--set",      "vehicle.footprint=point"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_qsmpc(small_run(folder.path(), arguments)).exit_code;
  };
  constexpr const char* kInTheWay =
      "{bounds: {x: [-2, 12], y: [-4, 4]}, obstacles: [{x: [0.8, 1.5], y: [-3, 3]}]}";
  EXPECT_EQ(exit_code(kInTheWay, {}), 1);
  EXPECT_EQ(nlohmann::json::parse(read_text(folder.path() + "/summary.json"))["outcome"],
            "collision");
  EXPECT_EQ(exit_code(kInTheWay, {"--fail-on", "none"}), 0);
  EXPECT_EQ(exit_code(kInTheWay, {"--fail-on", "left_bounds,fault"}), 0);
  EXPECT_EQ(exit_code(kInTheWay, {"--fail-on", "unsafe"}), 1);
  EXPECT_EQ(exit_code(kInTheWay, {"--fail-on", "left_safe_set"}), 1) << "the former word";
  EXPECT_EQ(exit_code("{bounds: {x: [-2, 12], y: [-4, 0.3]}}",
                      {"--set", "initial_state.mean=[0, 0, 1.2]"}),
            1);
  EXPECT_EQ(nlohmann::json::parse(read_text(folder.path() + "/summary.json"))["outcome"],
            "left_bounds");
  EXPECT_EQ(exit_code(kInTheWay, {"--fail-on", "colision"}), 2);
}

struct Broken {
  const char* name;
  const char* text;      // of the scenario file
  const char* expected;  // regular expression that the error line must match
};

constexpr const char* kValid =
    "name: a\nmodel: {system: dubins}\ninitial_state: {mean: [0, 0, 0]}\n"
    "target: {state: [1, 0, 0]}\n";

class RunBroken : public ::testing::TestWithParam<Broken> {};

TEST_P(RunBroken, is_refused_in_one_line_with_exit_code_2) {
  const TemporaryFolder folder;
  const std::string file = folder.file("broken.yaml", std::string(kValid) + GetParam().text);
  const ProcessResult result = run_qsmpc({"run", file, "--out", folder.path() + "/out"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_EQ(lines(result.errors), 1) << result.errors;
  EXPECT_THAT(result.errors, ContainsRegex(GetParam().expected));
  EXPECT_FALSE(exists(folder.path() + "/out"));
}

INSTANTIATE_TEST_SUITE_P(
    Scenarios, RunBroken,
    ::testing::Values(Broken{"unknown_key", "contoller: {horizon: 3}\n",
                             "broken.yaml:5: contoller: found .*expected .*controller"},
                      Broken{"wrong_size", "disturbance: {covariance: [1, 2]}\n",
                             "broken.yaml:5: disturbance.covariance: found .*expected .*3"},
                      Broken{"indefinite", "disturbance: {covariance: [1, 1, -1]}\n",
                             "broken.yaml:5: disturbance.covariance: found .*expected "},
                      Broken{"missing_xml", "plant: {mjcf: nowhere.xml}\n",
                             "broken.yaml:5: plant.mjcf: found .*nowhere.xml.*expected "},
                      Broken{"obstacle_over_start",
                             "safe_set: {obstacles: [{x: [-1, 1], y: [-1, 1]}]}\n",
                             "initial_state.mean: found .*expected "},
                      Broken{"not_a_number", "disturbance: {covariance: [.nan, 1, 1]}\n",
                             "broken.yaml:5: disturbance.covariance.*: found .*expected "},
                      Broken{"horizon_0", "controller: {horizon: 0}\n",
                             "broken.yaml:5: controller.horizon: found 0, expected "}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(Run, refuses_what_is_not_a_scenario_at_all) {
  const TemporaryFolder folder;
  std::string noise(10 << 20, '\0');
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = static_cast<char>((i * 2654435761U) >> 13);
  for (const std::string& path :
       {folder.file("empty.yaml", ""), folder.path(), folder.path() + "/missing.yaml",
        folder.file("noise.yaml", noise), folder.file("text.yaml", "{[}")}) {
    const ProcessResult result = run_qsmpc({"run", path, "--out", folder.path() + "/out"});
    EXPECT_EQ(result.exit_code, 2) << path;
    EXPECT_EQ(lines(result.errors), 1) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr("expected"));
  }
  EXPECT_EQ(run_qsmpc({"run"}).exit_code, 2);
  EXPECT_EQ(run_qsmpc({"run", "dubins_obstacles", "--no-such-option"}).exit_code, 2);
  EXPECT_EQ(run_qsmpc({"walk"}).exit_code, 2);
  EXPECT_EQ(run_qsmpc({}).exit_code, 2);
}

TEST(Run, an_output_folder_that_cannot_be_written_is_exit_code_3) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a_file", "");
  const ProcessResult result = run_qsmpc(small_run(file + "/below", {"--no-video"}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(lines(result.errors), 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(file));
}

// A file size limit stands in for a full disk: a write in the middle of the trace fails.
TEST(Run, a_full_disk_is_exit_code_3_and_leaves_nothing_half_written_under_a_final_name) {
  const TemporaryFolder folder;
  const ProcessResult result = run_qsmpc(small_run(folder.path()), {.file_size_limit = 30000});
  EXPECT_EQ(result.exit_code, 3) << result.errors;
  EXPECT_FALSE(exists(folder.path() + "/episode.h5"));
  EXPECT_FALSE(exists(folder.path() + "/episode.mp4"));
  EXPECT_FALSE(exists(folder.path() + "/summary.json"));
}

TEST(Run, an_interrupt_keeps_the_trace_and_a_playable_video) {
  const TemporaryFolder folder;
  const std::string partial = folder.path() + "/episode.h5.partial";
  const ProcessResult result =
      run_qsmpc({"run", "dubins_obstacles", "--set", "video.size=320x180", "--out", folder.path()},
                {.meanwhile = [&](pid_t process) {
                  // Once some steps are in the file; the whole episode is many times as large.
                  if (!exists(partial) || std::filesystem::file_size(partial) < 300000)
                    return false;
                  kill(process, SIGINT);
                  return true;
                }});
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  const Trace trace = read_trace(folder.path() + "/episode.h5");
  EXPECT_EQ(trace.outcome, Outcome::kInterrupted);
  EXPECT_GT(trace.steps.size(), 0U);
  EXPECT_THAT(probe(folder.path() + "/episode.mp4"), ::testing::StartsWith("h264,320,180,"));
  EXPECT_EQ(partial_files(folder.path()), 0);
}

TEST(Run, an_interrupt_while_the_video_is_drawn_is_reported_and_exits_with_130) {
  const TemporaryFolder folder;
  const std::string video = folder.path() + "/episode.mp4";
  // Many frames: drawing takes much longer than the signal's delivery.
  const ProcessResult result = run_qsmpc(
      small_run(folder.path(), {"--set", "video.size=1280x720", "--set", "video.fps=240"}),
      {.meanwhile = [&](pid_t process) {
        if (!exists(video + ".partial")) return false;
        kill(process, SIGINT);
        return true;
      }});
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_THAT(result.errors, ContainsRegex("interrupted: .*/episode.mp4 ends early, after [0-9]+ "
                                           "of 384 frames\n"));
  EXPECT_THAT(probe(video), ::testing::StartsWith("h264,1280,720,"));
  EXPECT_EQ(read_trace(folder.path() + "/episode.h5").outcome, Outcome::kTimeout);
  EXPECT_EQ(partial_files(folder.path()), 0);
}

/// Whether the process has installed its SIGTERM handler, which it does first.
bool catches_sigterm(pid_t process) {
  const std::string status = read_text("/proc/" + std::to_string(process) + "/status");
  const std::size_t at = status.find("SigCgt:");
  if (at == std::string::npos) return false;
  return (std::stoull(status.substr(at + 7), nullptr, 16) >> (SIGTERM - 1) & 1U) == 1U;
}

TEST(Run, a_plant_that_takes_very_many_steps_can_be_interrupted) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  // 20 million steps before the first period.
  const ProcessResult result = run_qsmpc(
      {"run", "double_integrator", "--out", out, "--set",
       "plant={kind: mujoco, mjcf: double_integrator_slider.xml, time_step: 1e-5, settling: 200, "
       "state: {position: {joint: slide}, velocity: {joint: slide, quantity: velocity}}, "
       "input: {acceleration: [{actuator: push}]}}"},
      {.meanwhile = [](pid_t process) {
        if (!catches_sigterm(process)) return false;
        kill(process, SIGTERM);
        return true;
      }});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.errors, "qsmpc: interrupted\n");
  EXPECT_FALSE(exists(out));  // driving has not even started
}

TEST(Run, sizes_beyond_the_memory_are_refused_before_anything_is_done) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  const ProcessResult result = run_qsmpc(
      {"run", "dubins_obstacles", "--out", out, "--set", "controller.horizon=1000", "--set",
       "controller.quantisation={state: 100000, noise: 10000, compressed: 100000}"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(lines(result.errors), 1) << result.errors;
  EXPECT_THAT(result.errors,
              ContainsRegex("controller.quantisation: found settings that need about "
                            ".* GB of memory"));
  EXPECT_FALSE(exists(out));
}

TEST(Run, a_killed_episode_can_be_rendered_and_reported_as_far_as_it_came) {
  const TemporaryFolder folder;
  const std::string partial = folder.path() + "/episode.h5.partial";
  const ProcessResult killed = run_qsmpc(
      {"run", "dubins_obstacles", "--out", folder.path()}, {.meanwhile = [&](pid_t process) {
        if (!exists(partial) || std::filesystem::file_size(partial) < 300000) return false;
        kill(process, SIGKILL);
        return true;
      }});
  ASSERT_EQ(killed.exit_code, 128 + SIGKILL);
  EXPECT_FALSE(exists(folder.path() + "/episode.h5"));
  EXPECT_EQ(run_qsmpc({"report", folder.path()}).exit_code, 0);
  EXPECT_EQ(run_qsmpc({"render", folder.path(), "--size", "160x90", "--fps", "5"}).exit_code, 0);
  EXPECT_THAT(probe(folder.path() + "/episode.mp4"), ::testing::StartsWith("h264,160,90,"));
}

TEST(Run, a_fault_of_the_plant_is_an_outcome_with_mujocos_message) {
  const TemporaryFolder folder;
  // With these gains the robot's wheels spin until MuJoCo fails.
  const ProcessResult result = run_qsmpc(
      {"run", "differential_robot", "--no-video", "--out", folder.path() + "/out", "--set",
       "limit.steps=6", "--set",
       "plant.input.yaw_rate=[{actuator: left_motor, gain: 1e18}, {actuator: right_motor, gain: "
       "-1e18}]"},
      {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("warning: the plant fails"));
  const auto summary = nlohmann::json::parse(read_text(folder.path() + "/out/summary.json"));
  EXPECT_EQ(summary["outcome"], "fault");
  EXPECT_FALSE(exists(folder.path() + "/MUJOCO_LOG.TXT"));
}

TEST(Run, a_vehicle_that_mujoco_does_not_load_is_a_wrong_file) {
  const TemporaryFolder folder;
  const std::string xml = folder.file("bad.xml", "<mujoco><worldbody><oops/></worldbody></mujoco>");
  for (const char* footprint : {"point", "from_mjcf"}) {
    const ProcessResult refused = run_qsmpc(
        small_run(folder.path() + "/none", {"--set", "plant.mjcf=" + xml, "--set",
                                            std::string("vehicle.footprint=") + footprint}),
        {.folder = folder.path()});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.errors, HasSubstr("oops"));
    EXPECT_FALSE(exists(folder.path() + "/none"));
  }
  EXPECT_FALSE(exists(folder.path() + "/MUJOCO_LOG.TXT"));
}

}  // namespace run_test
}  // namespace qsmpc::harness
