// Video files, written so that whatever happens there is either a whole file or none under the name
// asked for, and something playable beside it.
//
//   qsmpc::VideoWriter video("episode.mp4", 1280, 720, 30);
//   for (…) { renderer.draw(frame, image); video.add(image); }
//   video.finish();
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render/frame.hpp"
#include "render/media/video_format.hpp"

namespace qsmpc {

struct VideoOptions {
  std::optional<VideoFormat> format = std::nullopt;  ///< without: by the path's ending
  /// 0 (smallest file) … 100 (best picture). MP4: x264's rate factor 48 … 1; WebM: VP9's quantiser
  /// 59 … 4; GIF: 31 … 255 colours, all of them from 60 on; WebP: libwebp's quality 37 … 100.
  int quality = kUsualQuality;
  std::string preset = "veryfast";  ///< of MP4: x264's trade of time against size
  /// Encoder threads. The pictures do not depend on them; this x264's bytes differ from run to run.
  int threads = 2;
};

/// Writes pieces of a second each to PATH.partial, which stays playable if the process is killed,
/// and turns it into PATH at the end. The partial file of a GIF or WebP is a lossless MP4.
class VideoWriter {
 public:
  /// Throws std::invalid_argument when width or height is odd (4:2:0 halves them), a number is not
  /// positive or not within its range, or `path` ends with no known format and none is given;
  /// std::runtime_error with the path and the system's words when it cannot be written.
  VideoWriter(const std::string& path, int width, int height, int frames_per_second,
              const VideoOptions& options = {});

  /// Without `finish` nothing is left under the final name; PATH.partial keeps what was added.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  [[nodiscard]] VideoFormat format() const;

  /// Adds the next frame. Throws std::invalid_argument when its size is another one,
  /// std::runtime_error when it cannot be written.
  void add(const Image& image);

  /// Writes PATH, flushed to disk, and removes PATH.partial. An MP4 or WebM plays before it is
  /// wholly read. At least one frame must have been added. Throws std::runtime_error; PATH is then
  /// as it was before.
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace qsmpc
