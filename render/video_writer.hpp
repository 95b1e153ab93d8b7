// H.264 video files, written so that whatever happens there is either a whole file or none under
// the name asked for, and something playable beside it.
//
//   qsmpc::VideoWriter video("episode.mp4", 1280, 720, 30);
//   for (…) { renderer.draw(frame, image); video.add(image); }
//   video.finish();
#pragma once

#include <memory>
#include <string>

#include "render/frame.hpp"

namespace qsmpc {

struct VideoOptions {
  std::string preset = "veryfast";  ///< x264's trade of time against size
  int quality = 20;                 ///< x264's constant rate factor: 0 lossless … 51 worst
  /// Encoder threads. The pictures do not depend on them; this x264's bytes differ from run to run.
  int threads = 2;
};

/// Writes fragments of a second each to PATH.partial, which stays playable if the process is
/// killed, and turns it into PATH at the end.
class VideoWriter {
 public:
  /// Throws std::invalid_argument when width or height is odd (4:2:0 halves them) or a number is
  /// not positive, std::runtime_error with the path and the system's words when it cannot be
  /// written.
  VideoWriter(const std::string& path, int width, int height, int frames_per_second,
              const VideoOptions& options = {});

  /// Without `finish` nothing is left under the final name; PATH.partial keeps what was added.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Adds the next frame. Throws std::invalid_argument when its size is another one,
  /// std::runtime_error when it cannot be written.
  void add(const Image& image);

  /// Writes PATH as a plain MP4 that plays before it is wholly read, flushed to disk, and removes
  /// PATH.partial. At least one frame must have been added. Throws std::runtime_error; PATH is then
  /// as it was before.
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace qsmpc
