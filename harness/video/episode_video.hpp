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
  int fps = 30;                  ///< frames a second
  std::string camera = "chase";  ///< "chase", "top", "fixed" or "split"
  Overlays overlays{};
  const EpisodeView* beside = nullptr;  ///< an episode that is shown on the right; null: none
  int threads = 2;                      ///< that draw, at least 1; the result does not depend on it
  double speed = 1.0;                   ///< s of the episode shown in a second, 0.1 … 100
  double from = 0.0;                    ///< s of the episode, where the video begins
  double to = std::numeric_limits<double>::infinity();  ///< s, where it ends; at most the whole
  std::optional<render::VideoFormat> format = std::nullopt;  ///< without: by the path's ending
  int quality = render::kUsualQuality;                       ///< see VideoSettings
};

/// Writes a video to `path`. If it shows the end of the episode, it ends with a second in which the
/// outcome is shown, whatever the speed. `progress` (may be empty) is called on this thread after
/// each frame; when it returns false, the video is finished with the frames so far. What it throws
/// passes through; PATH.partial then keeps the frames. At most two pictures a thread are held in
/// memory. Throws std::invalid_argument on options that are none,
/// std::runtime_error when there is nothing to draw (see `why_not_drawn`), the vehicle cannot be
/// drawn or the file not be written; nothing new is then under `path`.
VideoTimings write_episode_video(const EpisodeView& view, const EpisodeVideoOptions& options,
                                 const std::string& path,
                                 const std::function<bool(int done, int total)>& progress = {});

/// One picture of the episode as a PNG. Throws like `write_episode_video`.
void write_episode_still(const EpisodeView& view, const EpisodeVideoOptions& options, double time,
                         const std::string& path);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
