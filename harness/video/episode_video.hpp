// The video of an episode, made from the view of its trace alone.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "harness/trace/episode_view.hpp"
#include "harness/video/overlays.hpp"
#include "harness/video/video_timings.hpp"
#include "render/media/video_format.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

struct EpisodeVideoOptions {
  int width = 1280;              ///< pixels, even
  int height = 720;              ///< pixels, even
  int fps = 30;                  ///< frames per second
  std::string camera = "chase";  ///< "chase", "top", "fixed" or "split"
  Overlays overlays{};
  const EpisodeView* beside = nullptr;  ///< an episode that is shown on the right; null: none
  int threads = 2;                      ///< number of drawing threads, at least 1; the result does
                                        ///< not depend on it
  double speed = 1.0;                   ///< seconds of the episode per second of video, 0.1 … 100
  double from = 0.0;                    ///< time of the episode at which the video begins, s
  double to = std::numeric_limits<double>::infinity();  ///< time at which it ends, s; at most the
                                                        ///< whole episode
  std::optional<render::VideoFormat> format = std::nullopt;  ///< by default from the path's
                                                             ///< extension
  int quality = render::kUsualQuality;                       ///< see VideoSettings
};

/// Writes a video to `path`. If it shows the end of the episode, it ends with one second that shows
/// the outcome, whatever the speed. `progress` (may be empty) is called on this thread after each
/// frame; when it returns false, the video is finished with the frames so far. Its exceptions pass
/// through; PATH.partial then keeps the frames. At most two pictures per thread are held in memory.
/// Throws std::invalid_argument on invalid options, and std::runtime_error if there is nothing to
/// draw (see `why_not_drawn`), the vehicle cannot be drawn or the file cannot be written; `path` is
/// then unchanged.
VideoTimings write_episode_video(const EpisodeView& view, const EpisodeVideoOptions& options,
                                 const std::string& path,
                                 const std::function<bool(int done, int total)>& progress = {});

/// Writes one picture of the episode as a PNG. Throws like `write_episode_video`.
void write_episode_still(const EpisodeView& view, const EpisodeVideoOptions& options, double time,
                         const std::string& path);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
