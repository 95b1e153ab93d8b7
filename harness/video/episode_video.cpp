#include "harness/video/episode_video.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "harness/files/atomic_file.hpp"
#include "harness/video/episode_painter.hpp"
#include "harness/video/ordered_drawing.hpp"
#include "harness/video/video_file.hpp"
#include "render/gl/gl_library.hpp"
#include "render/media/png_image.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kHoldTime = 1.0;         // how long the outcome is shown, s
constexpr double kSlowest = 0.1;          // seconds of the episode per second of video
constexpr double kFastest = 100.0;        // the same
constexpr double kFrameTolerance = 1e-6;  // of a frame: a shorter rest of the episode gets no extra
                                          // frame

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

VideoLayout layout_of(const EpisodeVideoOptions& options) {
  return {.width = options.width,
          .height = options.height,
          .camera = options.camera,
          .overlays = options.overlays};
}

// The moment of the episode that each frame of the video shows.
class Timetable {
 public:
  Timetable(const EpisodeVideoOptions& options, double duration)
      : from_(options.from),
        to_(std::min(options.to, duration)),
        step_(options.speed / options.fps) {
    if (!(options.speed >= kSlowest && options.speed <= kFastest)) {
      throw std::invalid_argument(fmt::format("video: a speed of {} is not within {} … {}",
                                              options.speed, kSlowest, kFastest));
    }
    if (!(from_ >= 0.0 && from_ <= to_)) {
      throw std::invalid_argument(fmt::format(
          "video: {} s to {} s is not part of an episode of {:.6g} s", from_, to_, duration));
    }
    const double hold = to_ >= duration ? kHoldTime * options.fps : 0.0;
    const double frames = (to_ - from_) / step_ + hold;
    total_ = std::max(1, static_cast<int>(std::ceil(frames - kFrameTolerance)));
  }

  [[nodiscard]] int total() const { return total_; }
  [[nodiscard]] double time(int index) const { return std::min(from_ + step_ * index, to_); }

 private:
  double from_;
  double to_;
  double step_;  // time of the episode from frame to frame, s
  int total_ = 0;
};

// One drawer per drawing thread: OpenGL contexts are bound to a thread.
OrderedDrawing::Drawer make_drawer(const EpisodePictures& pictures, const Timetable& timetable) {
  const auto painter = std::make_shared<EpisodePainter>(pictures);
  return [painter, timetable](int index, render::Image& out) {
    painter->draw(timetable.time(index), out);
  };
}

double mean_simulation_ms(const Trace& trace) {
  double sum = 0.0;
  for (const StepRecord& step : trace.steps) {
    sum += step.timing.simulate;
  }
  return trace.steps.empty() ? 0.0 : sum / static_cast<double>(trace.steps.size());
}

}  // namespace

VideoTimings write_episode_video(const EpisodeView& view, const EpisodeVideoOptions& options,
                                 const std::string& path,
                                 const std::function<bool(int done, int total)>& progress) {
  if (options.threads < 1) {
    throw std::invalid_argument("video: at least one thread is needed");
  }
  const Clock::time_point begin = Clock::now();
  const EpisodePictures pictures(view, layout_of(options), options.beside);
  const Timetable timetable(options, pictures.duration());
  const render::VideoFormat format =
      options.format ? *options.format : render::known_video_format(path);
  VideoFile video(path, {.format = format,
                         .width = options.width,
                         .height = options.height,
                         .frames_per_second = options.fps,
                         .quality = options.quality});
  OrderedDrawing drawing({.total = timetable.total(), .threads = options.threads},
                         [&] { return make_drawer(pictures, timetable); });
  VideoTimings timings{.fps = options.fps,
                       .from = options.from,
                       .speed = options.speed,
                       .width = options.width,
                       .height = options.height,
                       .codec = render::video_codec(format),
                       .simulation_ms = mean_simulation_ms(view.trace())};
  double encoding = 0.0;
  render::Image image;
  bool go_on = true;
  while (go_on && timings.frames < timetable.total()) {
    drawing.take(image);
    const Clock::time_point taken = Clock::now();
    video.add(image);
    encoding += seconds_since(taken);
    ++timings.frames;
    go_on = !progress || progress(timings.frames, timetable.total());
  }
  const double drawn = drawing.drawing_seconds();
  const Clock::time_point added = Clock::now();
  video.finish();
  encoding += seconds_since(added);
  timings.wall_s = seconds_since(begin);
  timings.drawing_ms = 1e3 * drawn / timings.frames;
  timings.gl = render::gl_description();
  timings.encoding_ms = 1e3 * encoding / timings.frames;
  return timings;
}

void write_episode_still(const EpisodeView& view, const EpisodeVideoOptions& options, double time,
                         const std::string& path) {
  const EpisodePictures pictures(view, layout_of(options), options.beside);
  EpisodePainter painter(pictures);
  render::Image image;
  painter.draw(time, image);
  write_file(path, render::encode_png(image));
}

}  // namespace qsmpc::harness
