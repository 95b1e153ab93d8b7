// How fast a video is drawn and encoded, and where the time goes. An episode with the requested
// number of particles is made up. Its pictures are drawn part by part on one thread, for the times
// of the parts, and then made into a video as `qsmpc render` does, for the total time.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/scenario/value_checks.hpp"
#include "harness/video/episode_frames.hpp"
#include "harness/video/episode_video.hpp"
#include "harness/video/video_file.hpp"
#include "render/camera.hpp"
#include "render/gl/gl_functions.hpp"
#include "render/gl/offscreen_context.hpp"
#include "render/gl/smoothing.hpp"
#include "render/hud/hud.hpp"
#include "render/palette.hpp"
#include "render/scene/scene_painter.hpp"
#include "render/scene/vehicle.hpp"
#include "tests/support/described_trace.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kStages = 9;
constexpr double kPeriod = 0.1;  // s
constexpr double kSpeed = 1.5;   // m/s
constexpr double kRadius = 5.0;  // m, of the circle that is driven

struct Options {
  int points = 1800;
  std::string size = "1280x720";
  int frames = 150;
  std::string format = "mp4";
  int threads = 2;
  double at_least = 30.0;  // frames per second
};

Eigen::Vector3d state_at(double time) {
  const double angle = kSpeed * time / kRadius;
  return {kRadius * std::sin(angle), kRadius * (1.0 - std::cos(angle)), angle};
}

// Points of a sunflower pattern: evenly spread, without random numbers.
StageParticles particles_about(const Eigen::Vector3d& centre, int stage, int count) {
  StageParticles particles{models::StateBatch(3, count),
                           Eigen::VectorXd::Constant(count, 1.0 / count)};
  for (int i = 0; i < count; ++i) {
    const double angle = 2.39996 * i;
    const double radius = 0.08 * (stage + 1) * std::sqrt((i + 0.5) / count);
    particles.locations.col(i) =
        centre + Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return particles;
}

StepRecord step_at(int index, int points) {
  StepRecord step;
  step.time = kPeriod * index;
  step.state = state_at(step.time);
  step.input = Eigen::VectorXd::Constant(1, kSpeed / kRadius);
  step.disturbance = Eigen::Vector3d::Zero();
  step.plan_states.resize(3, kStages);
  for (int stage = 0; stage < kStages; ++stage) {
    const Eigen::Vector3d state = state_at(step.time + kPeriod * stage);
    step.plan_states.col(stage) = state;
    step.particles.push_back(particles_about(state, stage, points / kStages));
  }
  step.certificates.resize(kStages - 1);
  step.certificates.front().value = 1e-4;
  return step;
}

Trace made_up_trace(const Options& options, int fps) {
  Trace trace;
  Scenario& scenario = trace.scenario;
  scenario.name = "video speed";
  scenario.model = {"dubins", {{"speed", kSpeed}}};
  scenario.plant = {"analytic", QSMPC_SOURCE_DIR "/models/mjcf/dubins_car.xml"};
  scenario.time_step = kPeriod;
  scenario.safe_set = controller::unbounded_safe_set(3);
  scenario.safe_set.bounds.lower << -7.0, -2.0, -HUGE_VAL;
  scenario.safe_set.bounds.upper << 7.0, 12.0, HUGE_VAL;
  for (const double x : {-2.0, 2.0}) {
    controller::Box obstacle = controller::unbounded_safe_set(3).bounds;
    obstacle.lower.head(2) << x - 0.6, 4.0;
    obstacle.upper.head(2) << x + 0.6, 6.0;
    scenario.safe_set.obstacles.push_back(obstacle);
  }
  scenario.target = {Eigen::Vector3d(0.0, 10.0, 0.0), 0.5};
  scenario.controller.cost = {Eigen::Matrix3d::Identity(), Eigen::MatrixXd::Identity(1, 1),
                              Eigen::Matrix3d::Identity()};
  const int steps = std::max(1, static_cast<int>(std::ceil(options.frames / (fps * kPeriod))));
  for (int index = 0; index < steps; ++index) {
    trace.steps.push_back(step_at(index, options.points));
  }
  trace.final_state = state_at(kPeriod * steps);
  trace.outcome = Outcome::kReached;
  return testing::described(std::move(trace));
}

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Wall-clock time, and processor time of all threads.
class Part {
 public:
  explicit Part(std::string name) : name_(std::move(name)) {}

  template <typename Action>
  void measure(const Action& action) {
    const double wall = seconds_of(CLOCK_MONOTONIC);
    const double processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    action();
    wall_ += seconds_of(CLOCK_MONOTONIC) - wall;
    processor_ += seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor;
  }

  void print(int frames) const {
    std::cout << fmt::format("  {:<22} {:7.1f} {:10.1f}\n", name_, 1e3 * wall_ / frames,
                             1e3 * processor_ / frames);
  }

 private:
  std::string name_;
  double wall_ = 0.0;
  double processor_ = 0.0;
};

struct Parts {
  Part vehicle{"vehicle"};
  Part scene{"scene without points"};
  Part scene_with_points{"scene with points"};
  Part reading{"read-back"};
  Part smoothing{"smoothing"};
  Part hud{"head-up display"};
  Part encoding{"conversion, encoding"};

  void print(int frames) const {
    std::cout << "ms per frame, in sequence   wall  processor\n";
    for (const Part* part :
         {&vehicle, &scene, &scene_with_points, &reading, &smoothing, &hud, &encoding}) {
      part->print(frames);
    }
  }
};

// Draws as Renderer::draw does, but waits for the GPU after each part.
class PartByPart {
 public:
  PartByPart(const Trace& trace, const EpisodeFrames& frames, const EpisodeVideoOptions& video,
             const std::string& path)
      : frames_(frames),
        video_(video),
        vehicle_(trace.scenario.plant.mjcf, video.width, video.height),
        painter_(frames.world(), frames.region()),
        hud_(video.width, video.height),
        column_{0.0, 0.0, hud_.column_width(), static_cast<double>(video.height)},
        writer_(path, {.format = render::known_video_format(path),
                       .width = video.width,
                       .height = video.height,
                       .frames_per_second = video.fps}) {}

  void draw(int index, Parts& parts) {
    const render::Frame frame = frames_.at(static_cast<double>(index) / video_.fps);
    render::Frame bare = frame;
    bare.particles.clear();
    const render::View view =
        render::chase_view(*frame.followed, 4.0, {video_.width, video_.height});
    vehicle_.place(frame);
    parts.vehicle.measure([&] { draw_vehicle(view); });
    parts.scene.measure([&] { paint(bare, view); });
    draw_vehicle(view);
    parts.scene_with_points.measure([&] { paint(frame, view); });
    parts.reading.measure([&] { vehicle_.read_picture(image_); });
    parts.smoothing.measure([&] { render::smooth_edges(image_, workspace_); });
    parts.hud.measure([&] { hud_.draw_column(frame, column_, image_); });
    parts.encoding.measure([&] { writer_.add(image_); });
  }

 private:
  void draw_vehicle(const render::View& view) {
    vehicle_.draw(view);
    render::glFinish();
  }
  void paint(const render::Frame& frame, const render::View& view) {
    painter_.paint(frame, view, vehicle_.marks(frame));
    render::glFinish();
  }

  const EpisodeFrames& frames_;
  EpisodeVideoOptions video_;
  render::OffscreenContext context_;  // must precede the members that draw with it
  render::Vehicle vehicle_;
  render::ScenePainter painter_;
  render::Hud hud_;
  render::PixelRectangle column_;
  render::SmoothingWorkspace workspace_;
  render::Image image_;
  VideoFile writer_;
};

bool run(const Options& options) {
  const std::optional<FrameSize> size = parse_frame_size(options.size);
  if (!size) throw std::invalid_argument("--size: expected " + expected_frame_size());
  EpisodeVideoOptions video{.width = size->width, .height = size->height};
  video.threads = options.threads;
  const testing::TemporaryFolder folder;
  const Trace trace = made_up_trace(options, video.fps);
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  {
    constexpr int kWarmUp = 3;  // pictures, for shader compilation
    constexpr int kMeasured = 40;
    PartByPart drawing(trace, frames, video, folder / ("parts." + options.format));
    Parts warm_up;
    Parts parts;
    for (int index = 0; index < kWarmUp + kMeasured; ++index) {
      drawing.draw(index, index < kWarmUp ? warm_up : parts);
    }
    parts.print(kMeasured);
  }
  const double processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  const VideoTimings timings =
      write_episode_video(view, video, folder / ("whole." + options.format));
  const double spent = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor;
  std::cout << fmt::format(
      "{}, {} points, {}, {} threads\n{}\n  {:.1f} ms of processor time per frame\n", options.size,
      options.points, options.format, options.threads, video_line(timings),
      1e3 * spent / timings.frames);
  return timings.frames_per_second() >= options.at_least;
}

}  // namespace
}  // namespace qsmpc::harness

int main(int argc, char** argv) {
  qsmpc::harness::Options options;
  CLI::App app("Speed of drawing and encoding a video, in total and by part");
  app.add_option("--points", options.points, "Particles per frame")->check(CLI::PositiveNumber);
  app.add_option("--size", options.size, "WIDTHxHEIGHT in pixels");
  app.add_option("--frames", options.frames, "Frames of the episode, at 30 per second")
      ->check(CLI::PositiveNumber);
  app.add_option("--format", options.format, "mp4, webm, gif or webp");
  app.add_option("--threads", options.threads, "Drawing threads")->check(CLI::PositiveNumber);
  app.add_option("--at-least", options.at_least,
                 "Frames per second below which the benchmark fails");
  CLI11_PARSE(app, argc, argv);
  try {
    return qsmpc::harness::run(options) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
