#include "harness/video/episode_video.hpp"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "harness/video/episode_frames.hpp"
#include "models/dynamics/dynamics.hpp"
#include "render/png_file.hpp"
#include "render/renderer.hpp"
#include "render/video_writer.hpp"

namespace qsmpc {
namespace {

constexpr double kHoldTime = 1.0;     // s, how long the outcome is shown
constexpr double kPlansInView = 2.8;  // chase camera's distance in lengths of the longest plan

RenderOptions render_options(const EpisodeVideoOptions& options, const EpisodeFrames& frames) {
  return {.width = options.width,
          .height = options.height,
          .camera = options.camera,
          .chase_distance = kPlansInView * frames.longest_plan(),
          .region = frames.region()};
}

// Threads that draw frames ahead of the one who takes them in order. OpenGL contexts belong to a
// thread, so each thread has a renderer of its own and draws every n-th frame.
class DrawingThreads {
 public:
  DrawingThreads(const EpisodeFrames& frames, const EpisodeVideoOptions& options,
                 std::string mjcf_path, int total)
      : frames_(frames),
        options_(options),
        mjcf_path_(std::move(mjcf_path)),
        total_(total),
        slots_(2 * static_cast<std::size_t>(options.threads)) {
    for (int worker = 0; worker < options.threads; ++worker) {
      threads_.emplace_back([this, worker] { draw_every_nth(worker); });
    }
  }

  ~DrawingThreads() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) {
      thread.join();
    }
  }
  DrawingThreads(const DrawingThreads&) = delete;
  DrawingThreads& operator=(const DrawingThreads&) = delete;

  // Swaps the picture of frame `index` into `image`. To be called for 0, 1, 2, … in order; throws
  // what a thread threw.
  void take(int index, Image& image) {
    std::unique_lock lock(mutex_);
    Slot& slot = slot_of(index);
    changed_.wait(lock, [&] { return error_ != nullptr || slot.frame == index; });
    if (error_ != nullptr) {
      std::rethrow_exception(error_);
    }
    std::swap(slot.image, image);
    slot.frame = -1;
    taken_ = index + 1;
    lock.unlock();
    changed_.notify_all();
  }

 private:
  struct Slot {
    int frame = -1;  // whose picture it holds; -1: none
    Image image;
  };

  Slot& slot_of(int index) { return slots_[static_cast<std::size_t>(index) % slots_.size()]; }

  // Whether the slot of frame `index` is free, which it is when the frame before in it was taken.
  bool wait_for_slot(int index) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stop_ || index < taken_ + static_cast<int>(slots_.size()); });
    return !stop_;
  }

  void draw_every_nth(int worker) {
    try {
      Renderer renderer(render_options(options_, frames_), frames_.world(), mjcf_path_);
      for (int index = worker; index < total_ && wait_for_slot(index); index += options_.threads) {
        // Nobody else touches this slot until its frame number is set.
        renderer.draw(frames_.at(static_cast<double>(index) / options_.fps), slot_of(index).image);
        {
          const std::lock_guard lock(mutex_);
          slot_of(index).frame = index;
        }
        changed_.notify_all();
      }
    } catch (...) {
      {
        const std::lock_guard lock(mutex_);
        error_ = error_ == nullptr ? std::current_exception() : error_;
      }
      changed_.notify_all();
    }
  }

  const EpisodeFrames& frames_;
  EpisodeVideoOptions options_;
  std::string mjcf_path_;
  int total_;
  std::vector<Slot> slots_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int taken_ = 0;
  bool stop_ = false;
  std::exception_ptr error_;
  std::vector<std::thread> threads_;  // last: they use the rest
};

void check_drawable(const Scenario& scenario) {
  const std::string reason = why_not_drawn(scenario);
  if (!reason.empty()) throw std::runtime_error("no video: " + reason);
}

}  // namespace

std::string why_not_drawn(const Scenario& scenario) {
  const auto model =
      make_dynamics(scenario.model.system, scenario.model.parameters, scenario.time_step);
  const SystemDescription& system = model->description();
  if (system.position_x < 0 || system.position_y < 0) {
    return system.name + " has no position in the plane";
  }
  return scenario.plant.mjcf.empty() ? "the scenario names no vehicle (plant.mjcf)" : "";
}

void write_episode_video(const Trace& trace, const EpisodeVideoOptions& options,
                         const std::string& path,
                         const std::function<bool(int done, int total)>& progress) {
  if (options.threads < 1) {
    throw std::invalid_argument("video: at least one thread must draw");
  }
  check_drawable(trace.scenario);
  const EpisodeFrames frames(trace);
  VideoWriter video(path, options.width, options.height, options.fps);
  const int total = static_cast<int>(std::ceil((frames.duration() + kHoldTime) * options.fps));
  DrawingThreads drawing(frames, options, trace.scenario.plant.mjcf, total);
  Image image;
  for (int index = 0; index < total; ++index) {
    drawing.take(index, image);
    video.add(image);
    if (progress && !progress(index + 1, total)) {
      break;
    }
  }
  video.finish();
}

Frame episode_frame(const Trace& trace, double time) { return EpisodeFrames(trace).at(time); }

void write_episode_still(const Trace& trace, const EpisodeVideoOptions& options, double time,
                         const std::string& path) {
  check_drawable(trace.scenario);
  const EpisodeFrames frames(trace);
  Renderer renderer(render_options(options, frames), frames.world(), trace.scenario.plant.mjcf);
  Image image;
  renderer.draw(frames.at(time), image);
  write_png(path, image);
}

}  // namespace qsmpc
